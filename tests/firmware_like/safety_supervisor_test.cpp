#include "firmware_like/safety_supervisor.hpp"

#include <CppUTest/TestHarness.h>

#include "firmware_like/robot_driver.hpp"

using namespace st;

namespace {

constexpr double kTick_s = 0.02;
constexpr WheelSpeeds kStraight{0.2, 0.2};

RobotStatus with(RobotFault fault) {
  RobotStatus status;
  status.fault = fault;
  return status;
}

// For how long it lets the robot drive when that is how things are; -1: for as long as anybody waits.
double drives_for_s(SafetySupervisor& supervisor, const Sight& sight, const WheelSpeeds& told,
                    double from_s) {
  for (int i = 0; i < 1000; ++i)
    if (supervisor.judge(from_s + i * kTick_s, {}, sight, told) != Reaction::kNone) return i * kTick_s;
  return -1;
}

// A robot of which a test says how it is, and which remembers what it was told.
class FakeBase final : public DriveBase {
 public:
  bool drive(double left_mps, double right_mps) override {
    left = left_mps, right = right_mps;
    return true;
  }
  bool stop() override { return drive(0, 0); }
  void poll(FixedVector<OdometrySample, 64>&, RobotStatus& status) override { status = with(fault); }
  RobotGeometry geometry() const override { return {}; }
  RobotModel model() const override { return RobotModel::kCreate2; }
  void close() override {}

  RobotFault fault = RobotFault::kNone;
  double left = 0, right = 0;
};

Path long_line() {
  Path path;
  path.add_line(10);
  path.plan();
  return path;
}

}  // namespace

TEST_GROUP(SafetySupervisor){};

TEST(SafetySupervisor, EndsTheDriveForEveryFaultOfTheRobotAndStaysEnded) {
  for (const RobotFault fault :
       {RobotFault::kSilent, RobotFault::kDisconnected, RobotFault::kBump, RobotFault::kCliff,
        RobotFault::kWheelDrop, RobotFault::kLeftSafeMode, RobotFault::kLowBattery}) {
    SafetySupervisor supervisor(Reaction::kEnd);
    CHECK(supervisor.judge(0, {}, {}, kStraight) == Reaction::kNone);
    CHECK(supervisor.judge(0.02, with(fault), {}, kStraight) == Reaction::kEnd);
    CHECK(supervisor.judge(0.04, {}, {}, kStraight) == Reaction::kEnd);
    CHECK(supervisor.fault() == fault);
    CHECK(rule_of(fault).reaction == Reaction::kEnd);
  }
}

TEST(SafetySupervisor, OnABumpHoldsOrGoesOnAsItIsTold) {
  SafetySupervisor holds(Reaction::kHold), ignores(Reaction::kNone);
  CHECK(holds.judge(1.0, with(RobotFault::kBump), {}, kStraight) == Reaction::kHold);
  CHECK(holds.judge(1.2, {}, {}, WheelSpeeds{}) == Reaction::kHold);
  CHECK(holds.judge(1.6, {}, {}, WheelSpeeds{}) == Reaction::kNone);
  CHECK(holds.judge(1.8, with(RobotFault::kCliff), {}, WheelSpeeds{}) == Reaction::kEnd);
  CHECK(ignores.judge(1.0, with(RobotFault::kBump), {}, kStraight) == Reaction::kNone);
}

TEST(SafetySupervisor, DrivesNoFurtherBlindThanStated) {
  SafetySupervisor slow(Reaction::kEnd), fast(Reaction::kEnd), never(Reaction::kEnd), far(Reaction::kEnd);
  const Sight blind{true, false, 0}, sees{true, true, 0};
  for (SafetySupervisor* s : {&slow, &fast}) s->judge(0, {}, sees, kStraight);
  DOUBLES_EQUAL(kBlindTime_s, drives_for_s(slow, blind, {0.1, 0.1}, kTick_s), 2 * kTick_s);
  CHECK(slow.fault() == RobotFault::kNotSeen);
  DOUBLES_EQUAL(kBlindDistance_m / 0.5, drives_for_s(fast, blind, {0.5, 0.5}, kTick_s), 2 * kTick_s);
  never.judge(0, {}, blind, WheelSpeeds{});
  DOUBLES_EQUAL(kUnseenTime_s, drives_for_s(never, blind, {0.1, 0.1}, kTick_s), 2 * kTick_s);
  far.judge(0, {}, blind, WheelSpeeds{});
  DOUBLES_EQUAL(kUnseenDistance_m / 0.4, drives_for_s(far, blind, {0.4, 0.4}, kTick_s), 2 * kTick_s);
}

TEST(SafetySupervisor, ATurnOnTheSpotIsDrivenBlindToo) {
  SafetySupervisor turns(Reaction::kEnd);
  turns.judge(0, {}, {true, true, 0}, {0.1, -0.1});
  DOUBLES_EQUAL(kBlindTime_s, drives_for_s(turns, {true, false, 0}, {0.1, -0.1}, kTick_s), 2 * kTick_s);
}

TEST(SafetySupervisor, WaitsOutOfSightAndDrivesWithoutACamera) {
  SafetySupervisor waiting(Reaction::kEnd), alone(Reaction::kEnd), seen(Reaction::kEnd);
  DOUBLES_EQUAL(-1, drives_for_s(waiting, {true, false, 0}, {}, 0), 0);
  DOUBLES_EQUAL(-1, drives_for_s(alone, {}, {0.5, 0.5}, 0), 0);
  DOUBLES_EQUAL(-1, drives_for_s(seen, {true, true, 0}, {0.5, 0.5}, 0), 0);
}

TEST(SafetySupervisor, HoldsWhileFramesAreLate) {
  SafetySupervisor supervisor(Reaction::kEnd);
  CHECK(supervisor.judge(0, {}, {true, true, 0.19}, kStraight) == Reaction::kNone);
  CHECK(supervisor.judge(0.03, {}, {true, true, 0.21}, kStraight) == Reaction::kHold);
  CHECK(supervisor.fault() == RobotFault::kStale);
  CHECK(supervisor.judge(0.06, {}, {true, true, 0.02}, WheelSpeeds{}) == Reaction::kNone);
  CHECK(supervisor.fault() == RobotFault::kNone);
}

TEST(SafetySupervisor, TheDriverStandsForAsLongAsItIsHeldAndGoesOnWithItsPath) {
  FakeBase base;
  const Path path = long_line();
  RobotDriver driver(base, Steering::kOpenLoop, &path, nullptr, Reaction::kHold);
  FixedVector<OdometrySample, 64> odometry;
  DriverView view;
  const auto drive = [&](double from_s, double to_s, const Sight& sight) {
    for (double t = from_s; t < to_s; t += 1 / 30.0) {
      driver.listen(odometry);
      view.sight = sight;
      driver.decide(t, view);
      driver.send();
    }
  };
  drive(0, 4, {true, true, 0.02});
  DOUBLES_EQUAL(0.2, base.left, 0.01);
  drive(4, 8, {true, true, 0.5});  // frames come half a second late
  DOUBLES_EQUAL(0.0, base.left, 0);
  CHECK(driver.held_by() == RobotFault::kStale && driver.fault() == RobotFault::kNone);
  drive(8, 9, {true, true, 0.02});
  DOUBLES_EQUAL(0.2, base.left, 0.01);
  driver.wait_without_frame(9.1);
  CHECK(base.left > 0);
  driver.wait_without_frame(9.3);
  DOUBLES_EQUAL(0.0, base.left, 0);
  drive(9.4, 10, {true, true, 0.02});
  base.fault = RobotFault::kCliff;
  drive(10, 10.1, {true, true, 0.02});
  DOUBLES_EQUAL(0.0, base.left, 0);
  CHECK(driver.fault() == RobotFault::kCliff);
}

// A loop that is starved has frames a fifth of a second apart: the wheels must not be thrown to and fro.
TEST(SafetySupervisor, LateFramesDoNotMakeTheDriverOvershoot) {
  FakeBase base;
  Path path;
  path.add_line(0.5);
  path.plan();
  RobotDriver driver(base, Steering::kOpenLoop, &path, nullptr, Reaction::kEnd);
  DriverView view;
  view.sight = {true, true, 0.1};
  double way_m = 0;
  for (double t = 0; t < 12; t += 0.19) {
    driver.decide(t, view);
    driver.send();
    CHECK(base.left > -0.03 && base.left < 0.26);
    way_m += 0.19 * base.left;
  }
  DOUBLES_EQUAL(0.5, way_m, 0.01);
}

TEST(SafetySupervisor, TheTableCanBeRead) {
  for (const SafetyRow& row : safety_rules()) {
    CHECK(row.name[0] != 0 && row.trigger[0] != 0 && row.limit[0] != 0 && row.what_to_do[0] != 0);
    CHECK(row.stands_within_ms > 111 && row.reaction != Reaction::kNone);
  }
}
