#include "hal/create/create_robot.hpp"

#include <cmath>

#include "algo/control/dead_reckoning.hpp"
#include "hal/error.hpp"
#include "tests/hal/create/processes.hpp"

// Last: it redefines new.
#include <CppUTest/TestHarness.h>

using namespace st;
using namespace st::test;

namespace {

struct Drive {
  std::unique_ptr<DriveBase> robot;
  DeadReckoning reckoning{0.235};
  RobotStatus status;

  // Commands 50 times a second, and takes what comes back.
  void keep(double left_mps, double right_mps, int ms) {
    FixedVector<OdometrySample, 64> odometry;
    for (int t = 0; t < ms; t += 20) {
      CHECK(robot->drive(left_mps, right_mps));
      sleep_ms(20);
      odometry.clear();
      robot->poll(odometry, status);
      for (const OdometrySample& sample : odometry) reckoning.add(sample);
    }
  }
};

RobotOptions on_port(const std::string& port, const std::string& log = {}) {
  RobotOptions options;
  options.port = port;
  options.log_path = log;
  return options;
}

std::string refusal(const RobotOptions& options) {
  try {
    open_robot(options);
  } catch (const Failure& failure) {
    LONGS_EQUAL(3, static_cast<int>(failure.code()));
    return failure.what();
  }
  return "opened";
}

}  // namespace

TEST_GROUP(CreateRobot){void setup() override{setenv("STARTRACK_BINARY", STARTRACK_BINARY, 1);
}
void teardown() override { unsetenv("STARTRACK_BINARY"); }
}
;

TEST(CreateRobot, FindsOutTheModelAndDrivesIt) {
  for (const char* model : {"create1", "create2"}) {
    SimulatedRobot simulated({"--model", model});
    Drive drive{open_robot(on_port(simulated.port())), DeadReckoning(0.235), {}};
    CHECK_EQUAL(std::string(model) == "create1", drive.robot->model() == RobotModel::kCreate1);
    drive.reckoning = DeadReckoning(drive.robot->geometry().wheel_base_m);
    drive.keep(0.1, 0.2, 1200);
    drive.keep(0, 0, 500);
    LONGS_EQUAL(0, static_cast<int>(drive.status.fault));
    LONGS_EQUAL(2, drive.status.oi_mode);
    const SimStateEntry truth = simulated.now();
    CHECK(truth.yaw_rad > 0.2);
    const bool encoders = drive.robot->model() == RobotModel::kCreate2;
    DOUBLES_EQUAL(truth.yaw_rad, drive.reckoning.pose().yaw, encoders ? 0.01 : 0.08);
    DOUBLES_EQUAL(truth.x_m, drive.reckoning.pose().x, encoders ? 0.003 : 0.02);
    drive.robot->close();
    drive.robot->close();
    DOUBLES_EQUAL(0.0, simulated.now().left_mps, 0);
  }
}

TEST(CreateRobot, PortSimBringsItsOwnRobotAndItsState) {
  Drive drive{open_robot(on_port("sim")), DeadReckoning(0.235), {}};
  SimStateReader state(drive.robot->sim_state_path());
  drive.keep(0.2, 0.2, 600);
  SimStateEntry truth;
  CHECK(state.newest(truth));
  CHECK(truth.x_m > 0.02);
  drive.robot->close();
  const std::uint64_t end = state.written();
  sleep_ms(50);
  UNSIGNED_LONGS_EQUAL(end, state.written());  // it has ended with the program
  CHECK(state.newest(truth));
  DOUBLES_EQUAL(0.0, truth.left_mps, 0);
}

TEST(CreateRobot, TheLogHoldsEveryByteAndDecodesToTheSameWay) {
  TempFolder folder;
  const std::string log = folder.file("robot.log");
  Drive drive{open_robot(on_port("sim", log)), DeadReckoning(0.235), {}};
  drive.keep(0.15, 0.25, 700);
  drive.keep(0, 0, 400);
  drive.robot->close();
  RobotLogReader reader;
  CHECK(reader.open(log));
  CHECK(reader.model() == RobotModel::kCreate2);
  DeadReckoning replayed(0.235);
  const RobotBytes decoder =
      decode_odometry(*reader.model(), reader.geometry(), [&](const OdometrySample& s) { replayed.add(s); });
  bool safe = false, goodbye = false;
  double last_t_s = 0;
  reader.pump_until_time(1e12, [&](double t_s, bool rx, std::span<const std::uint8_t> bytes) {
    decoder(t_s, rx, bytes);
    safe = safe || (!rx && bytes[0] == oi::kSafe);
    goodbye = !rx && bytes.back() == oi::kStop ? true : goodbye;
    CHECK(t_s >= last_t_s && t_s > 1.6e9);
    last_t_s = t_s;
  });
  UNSIGNED_LONGS_EQUAL(0, reader.bad_lines());
  CHECK(safe && goodbye);
  CHECK(replayed.pose().yaw > 0.1);
  DOUBLES_EQUAL(replayed.pose().yaw, drive.reckoning.pose().yaw, 1e-3);
}

TEST(CreateRobot, ADirtyLineCostsNoWay) {
  SimulatedRobot simulated({"--drop-bytes", "0.003", "--flip-bits", "0.003"});
  Drive drive{open_robot(on_port(simulated.port())), DeadReckoning(0.235), {}};
  drive.keep(0.2, 0.2, 1000);
  drive.keep(0, 0, 500);
  CHECK(drive.status.bad_bytes > 0);
  DOUBLES_EQUAL(simulated.now().x_m, drive.reckoning.pose().x, 0.003);
}

TEST(CreateRobot, SpeedsBeyondTheRobotKeepTheirCurve) {
  SimulatedRobot simulated;
  Drive drive{open_robot(on_port(simulated.port())), DeadReckoning(0.235), {}};
  drive.keep(0.5, 1.0, 800);
  DOUBLES_EQUAL(0.25, simulated.now().left_mps, 1e-9);
  DOUBLES_EQUAL(0.5, simulated.now().right_mps, 1e-9);
  CHECK_FALSE(drive.robot->drive(std::nan(""), 0.1));
  sleep_ms(600);
  DOUBLES_EQUAL(0.0, simulated.now().right_mps, 0);
}

TEST(CreateRobot, TellsItsFaults) {
  const struct {
    const char* event;
    RobotFault fault;
  } cases[] = {{"1:bump", RobotFault::kBump},
               {"1:cliff", RobotFault::kCliff},
               {"1:wheel-drop", RobotFault::kWheelDrop},
               {"1:charger", RobotFault::kLeftSafeMode},
               {"1:unplug", RobotFault::kSilent},
               {"0:low-battery", RobotFault::kLowBattery}};
  for (const auto& c : cases) {
    SimulatedRobot simulated({"--at", c.event});
    Drive drive{open_robot(on_port(simulated.port())), DeadReckoning(0.235), {}};
    bool told = false;
    for (int i = 0; i < 200 && !told; ++i) {
      drive.keep(0.1, 0.1, 20);
      told = drive.status.fault == c.fault;
    }
    CHECK_TEXT(told, name_of(c.fault));
  }
}

TEST(CreateRobot, ARobotThatVanishesIsDisconnected) {
  auto simulated = std::make_unique<SimulatedRobot>();
  Drive drive{open_robot(on_port(simulated->port())), DeadReckoning(0.235), {}};
  simulated.reset();
  FixedVector<OdometrySample, 64> odometry;
  for (int i = 0; i < 300 && drive.status.fault != RobotFault::kDisconnected; ++i, sleep_ms(10))
    drive.robot->poll(odometry, drive.status);
  LONGS_EQUAL(static_cast<int>(RobotFault::kDisconnected), static_cast<int>(drive.status.fault));
  CHECK_FALSE(drive.robot->drive(0.1, 0.1));
  drive.robot->close();
}

// The robot drives on while the cable is out; when it is back, it stands, and drives only after a stop().
TEST(CreateRobot, ComesBackInAStandstillAfterItsCableWasPulled) {
  for (const std::string out : {"pull", "unplug"}) {
    const std::string in = out == "pull" ? "replug" : "clear";
    SimulatedRobot simulated({"--at", "1.5:" + out, "--at", "3:" + in});
    Drive drive{open_robot(on_port(simulated.port())), DeadReckoning(0.235), {}};
    const auto keep_until = [&](auto done) {
      FixedVector<OdometrySample, 64> odometry;
      for (int i = 0; i < 400 && !done(); ++i, sleep_ms(20)) {
        drive.robot->drive(0.2, 0.2);
        odometry.clear();
        drive.robot->poll(odometry, drive.status);
      }
      CHECK(done());
    };
    // A pulled cable may first be noticed by the silence.
    const RobotFault fault = out == "pull" ? RobotFault::kDisconnected : RobotFault::kSilent;
    keep_until([&] { return drive.status.fault == fault; });
    DOUBLES_EQUAL(0.2, simulated.now().v_mps, 1e-6);  // which no software can help
    keep_until([&] { return drive.status.fault == RobotFault::kNone && drive.status.oi_mode == 2; });
    LONGS_EQUAL(out == "pull" ? 1 : 0, drive.status.reconnects);
    drive.keep(0.2, 0.2, 400);
    DOUBLES_EQUAL(0.0, simulated.now().v_mps, 0);
    drive.robot->stop();
    keep_until([&] {
      // When the computer stalls, the robot is silent to it once more, and stands until the next stop().
      if (drive.status.fault != RobotFault::kNone) drive.robot->stop();
      return std::fabs(simulated.now().v_mps - 0.2) < 1e-6;
    });
  }
}

TEST(CreateRobot, FindsASlowRobotAndSpeedsItUp) {
  SimulatedRobot simulated({"--baud", "19200"});
  Drive drive{open_robot(on_port(simulated.port())), DeadReckoning(0.235), {}};
  drive.keep(0.2, 0.2, 300);
  CHECK(drive.status.good_frames > 10);
}

TEST(CreateRobot, MeasuredWheelsChangeWhatItIsToldAndWhatItTells) {
  SimulatedRobot simulated({"--left-scale", "0.95", "--right-scale", "0.95", "--base-scale", "1.1"});
  RobotOptions options = on_port(simulated.port());
  options.wheels = {0.235 * 1.1, 0.072 * 0.95, 0};
  Drive drive{open_robot(options), DeadReckoning(0.235 * 1.1), {}};
  drive.keep(0.15, 0.25, 1000);
  DOUBLES_EQUAL(0.2, simulated.now().v_mps, 0.002);
  drive.keep(0, 0, 400);
  DOUBLES_EQUAL(simulated.now().yaw_rad, drive.reckoning.pose().yaw, 0.01);
  DOUBLES_EQUAL(simulated.now().x_m, drive.reckoning.pose().x, 0.003);
}

TEST(CreateRobot, SaysWhatToDoWhenItCannotOpen) {
  STRCMP_CONTAINS("no such port", refusal(on_port("/dev/no-such-robot")).c_str());
  STRCMP_CONTAINS("not a serial port", refusal(on_port("/dev/null")).c_str());
  SimulatedRobot simulated;
  const auto first = open_robot(on_port(simulated.port()));
  STRCMP_CONTAINS("in use", refusal(on_port(simulated.port())).c_str());
}

TEST(CreateRobot, SaysWhenNobodyAnswers) {
  SimulatedRobot simulated({"--at", "0:unplug"});
  STRCMP_CONTAINS("no answer", refusal(on_port(simulated.port())).c_str());
  SimulatedRobot other({"--model", "create1"});
  RobotOptions told = on_port(other.port());
  told.model = RobotModel::kCreate2;
  STRCMP_CONTAINS("answers like a Create 1", refusal(told).c_str());
}

TEST(CreateRobot, WillNotDriveFromTheCharger) {
  SimulatedRobot simulated({"--at", "0:charger"});
  STRCMP_CONTAINS("refuses Safe mode", refusal(on_port(simulated.port())).c_str());
}

// A program that died in the middle of a command left the robot waiting for the rest.
TEST(CreateRobot, WakesARobotThatWaitsForData) {
  for (const std::string& torn :
       {std::string("\x80\x91\x00", 3), std::string("\x80\xa7\x01", 3), std::string("\x80\x8c\x00\x10", 4)}) {
    SimulatedRobot simulated;
    {
      RobotPort port(simulated.port(), 115200);
      port.write({reinterpret_cast<const std::uint8_t*>(torn.data()), torn.size()});
      sleep_ms(50);
    }
    Drive drive{open_robot(on_port(simulated.port())), DeadReckoning(0.235), {}};
    drive.keep(0.2, 0.2, 300);
    CHECK(simulated.now().x_m > 0.005);
  }
}
