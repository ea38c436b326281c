#include "firmware_like/safety_supervisor.hpp"

#include <CppUTest/TestHarness.h>

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

TEST(SafetySupervisor, TheTableCanBeRead) {
  for (const SafetyRow& row : safety_rules()) {
    CHECK(row.name[0] != 0 && row.trigger[0] != 0 && row.limit[0] != 0 && row.what_to_do[0] != 0);
    CHECK(row.stands_within_ms > 111 && row.reaction != Reaction::kNone);
  }
}
