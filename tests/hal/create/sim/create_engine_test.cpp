#include "hal/create/sim/create_engine.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "algo/control/dead_reckoning.hpp"
#include "algo/control/follower.hpp"
#include "algo/core/scalar_math.hpp"
#include "hal/create/odometry_decoder.hpp"

using namespace st;
using sim::CreateEngine;
using sim::CreateOptions;

namespace {

CreateOptions create1() {
  CreateOptions options;
  options.model = RobotModel::kCreate1;
  return options;
}

void say(CreateEngine& robot, std::initializer_list<int> bytes, double wait_s = 0.02) {
  std::vector<std::uint8_t> command;
  for (const int b : bytes) command.push_back(static_cast<std::uint8_t>(b));
  robot.receive(command);
  robot.step(wait_s);
}

std::vector<std::uint8_t> hear(CreateEngine& robot) {
  std::vector<std::uint8_t> bytes(100000);
  bytes.resize(robot.transmit(bytes));
  return bytes;
}

int ask(CreateEngine& robot, int packet) {
  hear(robot);
  say(robot, {142, packet});
  const auto reply = hear(robot);
  if (reply.size() == 1) return reply[0];
  UNSIGNED_LONGS_EQUAL(2, reply.size());
  return static_cast<std::int16_t>(reply[0] << 8 | reply[1]);
}

}  // namespace

TEST_GROUP(CreateEngine){};

TEST(CreateEngine, HearsOnlyStartWhileOff) {
  CreateEngine robot({});
  say(robot, {131, 142, 35});
  LONGS_EQUAL(oi::kOff, robot.mode());
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  say(robot, {128});
  LONGS_EQUAL(oi::kPassive, robot.mode());
  LONGS_EQUAL(1, ask(robot, 35));
}

TEST(CreateEngine, MovesInSafeModeAndNotInPassive) {
  CreateEngine robot({});
  say(robot, {128, 145, 0, 200, 0, 200}, 1);
  CHECK(robot.standing());
  say(robot, {131, 145, 0, 200, 0, 200}, 1);
  DOUBLES_EQUAL(0.2, robot.body().v(), 1e-9);
  LONGS_EQUAL(200, ask(robot, 41));
  say(robot, {131}, 1);  // entering Safe turns the motors off
  CHECK(robot.standing());
}

TEST(CreateEngine, SilenceGoesOnDriving) {
  CreateEngine robot({});
  say(robot, {128, 131, 145, 0, 100, 0, 100}, 60);
  DOUBLES_EQUAL(0.1, robot.body().v(), 1e-9);
  CHECK(robot.body().pose().x > 5.9);
}

TEST(CreateEngine, DriveTurnsOnItsRadius) {
  CreateEngine robot({});
  say(robot, {128, 131, 137, 0, 200, 1, 244}, 1);  // 200 mm/s, 500 mm to the left
  DOUBLES_EQUAL(0.2, robot.body().v(), 1e-9);
  DOUBLES_EQUAL(0.4, robot.body().w(), 0.01);
  say(robot, {137, 0, 200, 255, 255}, 1);  // on the spot, to the right
  DOUBLES_EQUAL(0.0, robot.body().v(), 1e-9);
  DOUBLES_EQUAL(-0.4 / 0.235, robot.body().w(), 1e-9);
}

TEST(CreateEngine, ACommandWithoutItsDataEatsTheNext) {
  CreateEngine robot({});
  say(robot, {128, 131, 145, 0, 100, 0}, 5);
  CHECK(robot.standing());
  say(robot, {145, 0, 0, 0, 0}, 1);  // 145 completes the first; the rest is no command
  DOUBLES_EQUAL(0.1225, robot.body().v(), 1e-9);
}

TEST(CreateEngine, OpcodeOneThirtySixIsLongerOnTheCreate1) {
  // As data of Demo, 131 does nothing; after Max clean it is Safe.
  CreateEngine one(create1()), two({});
  for (CreateEngine* robot : {&one, &two}) say(*robot, {128, 136, 131});
  LONGS_EQUAL(oi::kPassive, one.mode());
  LONGS_EQUAL(oi::kSafeMode, two.mode());
}

TEST(CreateEngine, SafeModeFallsToPassiveAndFullDoesNot) {
  for (const bool full : {false, true}) {
    CreateEngine robot({});
    say(robot, {128, full ? 132 : 131, 145, 0, 200, 0, 200}, 1);
    robot.world().cliffs = 1;
    robot.step(1);
    CHECK_EQUAL(full, robot.mode() == oi::kFullMode);
    CHECK_EQUAL(!full, robot.standing());
    LONGS_EQUAL(1, ask(robot, 9));
  }
  CreateEngine backwards({});
  say(backwards, {128, 131, 145, 255, 56, 255, 56}, 1);
  backwards.world().cliffs = 1;
  backwards.step(1);
  LONGS_EQUAL(oi::kSafeMode, backwards.mode());
  backwards.world().wheel_drops = 4;
  backwards.step(1);
  LONGS_EQUAL(oi::kPassive, backwards.mode());
  LONGS_EQUAL(4, ask(backwards, 7));
}

TEST(CreateEngine, StreamsEveryFifteenMillisecondsWithTheChecksum) {
  CreateEngine robot({});
  say(robot, {128, 148, 2, 29, 13}, 0.3);
  const auto bytes = hear(robot);
  UNSIGNED_LONGS_EQUAL(0, bytes.size() % 8);
  CHECK(bytes.size() / 8 >= 18 && bytes.size() / 8 <= 20);
  unsigned sum = 0;
  for (int i = 0; i < 8; ++i) sum += bytes[static_cast<std::size_t>(i)];
  LONGS_EQUAL(19, bytes[0]);
  LONGS_EQUAL(5, bytes[1]);
  LONGS_EQUAL(0, sum & 255);
  say(robot, {150, 0}, 0.1);
  hear(robot);
  robot.step(0.1);
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  say(robot, {150, 1}, 0.1);
  CHECK(!hear(robot).empty());
}

TEST(CreateEngine, TheLineTakesTenBitsAByte) {
  CreateEngine robot({});
  say(robot, {128});
  hear(robot);
  say(robot, {142, 100}, 0.0035);  // 80 bytes: 6.9 ms at 115200 baud
  const std::size_t early = hear(robot).size();
  CHECK(early > 20 && early < 45);
  robot.step(0.005);
  UNSIGNED_LONGS_EQUAL(80, early + hear(robot).size());
}

TEST(CreateEngine, AStreamThatDoesNotFitItsSlotIsTorn) {
  CreateEngine robot(create1());
  say(robot, {128, 148, 3, 6, 6, 6}, 1);  // 159 bytes a slot, and 86 fit
  StreamParser parser(RobotModel::kCreate1);
  SensorState state;
  for (const std::uint8_t byte : hear(robot))
    for (parser.push(byte); parser.next(state);) {
    }
  UNSIGNED_LONGS_EQUAL(0, parser.good_frames());
}

TEST(CreateEngine, TheWrongSpeedIsGarbageBothWays) {
  CreateEngine robot({});
  say(robot, {128, 148, 1, 35}, 0.1);
  hear(robot);
  robot.set_host_baud(57600);
  robot.step(1.0);
  StreamParser parser(RobotModel::kCreate2);
  SensorState state;
  const auto bytes = hear(robot);
  CHECK(!bytes.empty());
  for (const std::uint8_t byte : bytes)
    for (parser.push(byte); parser.next(state);) {
    }
  UNSIGNED_LONGS_EQUAL(0, parser.good_frames());
  say(robot, {131}, 0.1);
  LONGS_EQUAL(oi::kPassive, robot.mode());
}

TEST(CreateEngine, TheBaudCommandChangesTheSpeed) {
  CreateEngine robot({});
  say(robot, {128, 129, 10}, 0.1);
  LONGS_EQUAL(57600, robot.baud());
  robot.set_host_baud(57600);
  LONGS_EQUAL(1, ask(robot, 35));
}

TEST(CreateEngine, ResetPrintsABannerAndTurnsOff) {
  CreateEngine robot({});
  say(robot, {128, 131, 7}, 0.1);
  const auto bytes = hear(robot);
  STRCMP_CONTAINS("r3_robot/tags/release", std::string(bytes.begin(), bytes.end()).c_str());
  LONGS_EQUAL(oi::kOff, robot.mode());
}

TEST(CreateEngine, EncodersCountTheWayAndPassTheWrap) {
  CreateEngine robot({});
  say(robot, {128, 131});
  const auto left = static_cast<std::uint16_t>(ask(robot, 43)),
             right = static_cast<std::uint16_t>(ask(robot, 44));
  CHECK(left > 64500 && right > 31700 && right < 32768);
  say(robot, {145, 1, 44, 1, 44}, 5);
  say(robot, {145, 0, 0, 0, 0}, 1);
  const auto counted = static_cast<std::uint16_t>(static_cast<std::uint16_t>(ask(robot, 43)) - left);
  DOUBLES_EQUAL(robot.body().pose().x, counted * 0.000444565, 0.001);
  CHECK(static_cast<std::uint16_t>(ask(robot, 43)) < 64500);
  CHECK(static_cast<std::uint16_t>(ask(robot, 44)) > 32768);
}

TEST(CreateEngine, DistanceAndAngleClearOnReading) {
  CreateEngine robot(create1());
  say(robot, {128, 131, 145, 0, 0, 0, 0});
  ask(robot, 19);
  say(robot, {145, 0, 200, 0, 200}, 2);
  say(robot, {145, 0, 0, 0, 0}, 1);
  DOUBLES_EQUAL(robot.body().pose().x * 1000, ask(robot, 19), 1.5);
  LONGS_EQUAL(0, ask(robot, 19));
  say(robot, {137, 0, 100, 0, 1}, 2);  // to the left, on the spot
  say(robot, {145, 0, 0, 0, 0}, 1);
  DOUBLES_EQUAL(robot.body().pose().yaw * 180 / kPi, ask(robot, 20), 1.5);
  LONGS_EQUAL(0, ask(robot, 20));
}

TEST(CreateEngine, ReadingTheAngleTooOftenLosesItWhereTheFractionIsNotKept) {
  for (const bool keeps : {false, true}) {
    CreateOptions options = create1();
    options.angle_keeps_fraction = keeps;
    CreateEngine robot(options);
    say(robot, {128, 131, 137, 0, 50, 0, 1}, 0.5);  // 22 deg/s
    ask(robot, 20);
    const double before = robot.body().pose().yaw;
    int sum = 0;
    for (int i = 0; i < 60; ++i) sum += ask(robot, 20);  // every 20 ms: 0.44 deg
    const double turned = (robot.body().pose().yaw - before) * 180 / kPi;
    if (keeps)
      DOUBLES_EQUAL(turned, sum, 1.5);
    else
      LONGS_EQUAL(0, sum);
  }
}

TEST(CreateEngine, FallsAsleepIdleInPassiveAndHearsNothingUntilItsButtonIsPressed) {
  CreateEngine robot({});
  say(robot, {128}, 299);
  LONGS_EQUAL(oi::kPassive, robot.mode());
  robot.step(2);
  CHECK(robot.asleep());
  say(robot, {128, 128, 142, 35}, 1);
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  robot.press_power();
  say(robot, {128}, 0.1);
  LONGS_EQUAL(1, ask(robot, 35));
  CreateEngine one(create1()), safe({});
  say(one, {128}, 400);
  CHECK_FALSE(one.asleep());  // its specification knows no sleep
  say(safe, {128, 131}, 400);
  CHECK_FALSE(safe.asleep());  // in Safe it runs its battery down instead
}

TEST(CreateEngine, SeeksTheDockByItselfAndStandsOnIt) {
  CreateEngine robot({});
  robot.world().dock_near = true;
  say(robot, {128, 142, 17}, 0.1);
  LONGS_EQUAL(173, hear(robot).back());
  say(robot, {143}, 1);
  CHECK(robot.body().v() > 0);
  LONGS_EQUAL(oi::kPassive, robot.mode());
  robot.step(3);
  CHECK(robot.standing());
  CHECK(robot.world().on_charger);
  LONGS_EQUAL(2, ask(robot, 34));
  robot.world().charging_state = 6;  // which the Create 2's own table allows
  LONGS_EQUAL(6, ask(robot, 21));
  CreateEngine stopped({});
  stopped.world().dock_near = true;
  say(stopped, {128, 143}, 1);
  say(stopped, {131}, 1);  // what ends it
  CHECK(stopped.standing());
}

TEST(CreateEngine, BlockedWheelsTellByTheirCurrents) {
  CreateEngine robot({});
  say(robot, {128, 131, 145, 0, 200, 0, 200}, 0.5);
  robot.world().blocked = true;
  robot.step(1);
  CHECK(robot.standing());
  LONGS_EQUAL(24, ask(robot, 14));
  CHECK(ask(robot, 54) > 1000);
  LONGS_EQUAL(0, ask(robot, 58));
}

TEST(CreateEngine, StartsAtTheSpeedItIsTold) {
  CreateOptions options;
  options.start_baud = 19200;
  CreateEngine robot(options);
  robot.set_host_baud(19200);
  say(robot, {128}, 0.1);
  LONGS_EQUAL(1, ask(robot, 35));
  say(robot, {129, 11}, 0.1);
  robot.set_host_baud(115200);
  LONGS_EQUAL(1, ask(robot, 35));
}

TEST(CreateEngine, HalfFramesAndBytesTwiceAreTheOnlyOnesLost) {
  CreateOptions options;
  options.half_frames = 0.2;
  options.noise.duplicate = 0.002;
  CreateEngine robot(options);
  say(robot, {128, 148, 1, 100}, 30);
  std::vector<std::uint8_t> bytes(400000);
  bytes.resize(robot.transmit(bytes));
  StreamParser parser(RobotModel::kCreate2);
  const std::uint8_t list[] = {100};
  parser.expect(list);
  SensorState state;
  for (const std::uint8_t byte : bytes)
    for (parser.push(byte); parser.next(state);) LONGS_EQUAL(19, state.value(oi::kTemperature));
  const double share = static_cast<double>(parser.good_frames()) / 2000;
  CHECK(share > 0.6 && share < 0.75);  // 0.8 whole ones, of which 0.84 without a doubled byte
}

TEST(CreateEngine, LightsAndOutputsAreKept) {
  CreateEngine robot(create1());
  say(robot, {128, 139, 2, 0, 255}, 0.1);
  LONGS_EQUAL(0, robot.lights()[0]);  // not in Passive
  say(robot, {131, 139, 2, 10, 255, 147, 5, 138, 3}, 0.1);
  LONGS_EQUAL(2, robot.lights()[0]);
  LONGS_EQUAL(10, robot.lights()[1]);
  LONGS_EQUAL(5 << 8 | 3, robot.outputs());
}

// 100 m in both directions, through the wrap of both encoders: only the wheels' own size may show.
TEST(CreateEngine, OdometryOverAHundredMetresErrsByScaleAlone) {
  for (const RobotModel model : {RobotModel::kCreate1, RobotModel::kCreate2}) {
    CreateOptions options;
    options.model = model;
    options.errors.left_scale = options.errors.right_scale = 1.02;
    CreateEngine robot(options);
    RobotGeometry wheels = oi::default_geometry(model);
    wheels.wheel_diameter_m *= 1.02;  // as measured
    OdometryStream stream(model, wheels);
    DeadReckoning reckoning(wheels.wheel_base_m);
    Path path;
    path.limits.speed_mps = 0.4;
    double travelled_m = 0;
    for (int i = 0; i < 4; ++i) {
      path.add_line(15);
      path.add_turn(kPi / 2);
      path.add_line(-10);
      path.add_arc(0.5, -kPi / 2);
    }
    path.plan();
    const std::vector<std::uint8_t> lists[] = {{41, 42, 43, 44}, {41, 42}, {41, 42, 19, 20}};
    say(robot, {128, 131}, 0.1);
    hear(robot);
    OpenLoopFollower follower(path, oi::default_geometry(model).wheel_base_m);
    const auto listen = [&](double t_s) {
      const auto bytes = hear(robot);
      stream.receive(
          t_s, bytes, [](const SensorState&) {},
          [&](const OdometrySample& s) {
            reckoning.add(s);
            travelled_m += 0.5 * std::fabs(s.left_m + s.right_m);
          });
    };
    double t_s = 0;
    for (int tick = 0; !follower.done() || tick % 20 != 0; ++tick, t_s += 0.015) {
      const WheelSpeeds s = follower.step(0.015, 0.015);
      robot.receive(oi::drive_direct(static_cast<int>(std::lround(s.left_mps * 1000)),
                                     static_cast<int>(std::lround(s.right_mps * 1000)))
                        .span());
      const auto& list = model == RobotModel::kCreate2 ? lists[0] : tick % 20 == 10 ? lists[2] : lists[1];
      robot.receive(oi::stream(list).span());
      stream.sent(oi::stream(list).span());
      robot.step(0.015);
      listen(t_s);
    }
    robot.receive(oi::halt().span());
    for (int i = 0; i < 20; ++i, t_s += 0.015) {
      robot.step(0.015);
      listen(t_s);
    }
    const Pose2 truth = robot.body().pose(), told = reckoning.pose();
    CHECK(travelled_m > 100);
    const bool encoders = model == RobotModel::kCreate2;
    DOUBLES_EQUAL(truth.yaw, told.yaw, encoders ? 0.002 : 0.03);
    // A Create 1 tells its angle in whole degrees: half of one over all the way.
    CHECK(std::hypot(truth.x - told.x, truth.y - told.y) <
          (encoders ? 0.005 : travelled_m * 0.5 * kPi / 180));
    UT_PRINT(StringFromFormat("%s, %.0f m: %.1f mm and %.2f deg off", encoders ? "Create 2" : "Create 1",
                              travelled_m, 1000 * std::hypot(truth.x - told.x, truth.y - told.y),
                              (told.yaw - truth.yaw) * 180 / kPi)
                 .asCharString());
  }
}

// The whole chain in simulated time: path, follower, bytes, robot, bytes, wheel travel.
TEST(CreateEngine, ACircleDrivenOpenLoopHasItsRadius) {
  for (const RobotModel model : {RobotModel::kCreate1, RobotModel::kCreate2}) {
    CreateOptions options;
    options.model = model;
    CreateEngine robot(options);
    say(robot, {128, 131});
    Path path;
    path.add_arc(0.5, 2 * kPi);
    path.plan();
    OpenLoopFollower follower(path, oi::default_geometry(model).wheel_base_m);
    double worst = 0;
    while (!follower.done()) {
      const WheelSpeeds s = follower.step(0.02, 0.02);
      robot.receive(oi::drive_direct(static_cast<int>(std::lround(s.left_mps * 1000)),
                                     static_cast<int>(std::lround(s.right_mps * 1000)))
                        .span());
      robot.step(0.02);
      const Pose2 at = robot.body().pose();
      worst = std::max(worst, std::fabs(std::hypot(at.x, at.y - 0.5) - 0.5));
    }
    robot.receive(oi::halt().span());
    robot.step(1);
    CHECK(worst < 0.004);
    DOUBLES_EQUAL(0.0, std::hypot(robot.body().pose().x, robot.body().pose().y), 0.01);
    DOUBLES_EQUAL(2 * kPi, robot.body().pose().yaw, 0.01);
  }
}

TEST(CreateEngine, AnyBytesWhateverDoNoHarm) {
  sim::Random random(23);
  for (const RobotModel model : {RobotModel::kCreate1, RobotModel::kCreate2}) {
    CreateOptions options;
    options.model = model;
    CreateEngine robot(options);
    for (int i = 0; i < 3000; ++i) {
      std::vector<std::uint8_t> bytes(static_cast<std::size_t>(1 + random.below(30)));
      for (auto& b : bytes)
        b = static_cast<std::uint8_t>(random.below(3) == 0 ? 128 + random.below(46) : random.below(256));
      robot.receive(bytes);
      robot.step(0.01);
      hear(robot);
      CHECK(std::fabs(robot.body().v()) <= 0.5 + 1e-9);
    }
  }
}
