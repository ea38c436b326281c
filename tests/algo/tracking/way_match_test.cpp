#include "algo/tracking/way_match.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace st;

namespace {

constexpr double kPeriod_s = 1.0 / 30;

// Drives on an arc; its origin lies beside the turning centre.
struct Robot {
  Pose2 base;
  WheelOdometry wheels{true, 0, 0, kPeriod_s};
  void drive(double v_mps, double w_rps) {
    wheels.forward_m = v_mps * kPeriod_s;
    wheels.turn_rad = w_rps * kPeriod_s;
    base.x += std::cos(base.yaw) * wheels.forward_m;
    base.y += std::sin(base.yaw) * wheels.forward_m;
    base.yaw += wheels.turn_rad;
  }
  double x(double ahead_m) const { return base.x + ahead_m * std::cos(base.yaw); }
  double y(double ahead_m) const { return base.y + ahead_m * std::sin(base.yaw); }
};

}  // namespace

TEST_GROUP(WayMatch) {
  WayMatch match;
  Robot robot;
};

TEST(WayMatch, FindsTheRobotAmongWhatStandsAndWalks) {
  int first = 0;
  for (int k = 0; k < 200; ++k) {
    robot.drive(k < 30 ? 0 : 0.2, 0.4);
    match.begin_frame(robot.wheels);
    match.add(1, 2, 1);                                          // stands
    match.add(2, robot.x(0.03), robot.y(0.03));                  // obeys
    match.add(3, 0.6 * k * kPeriod_s, 0.2 * std::sin(0.2 * k));  // walks
    if (first == 0 && match.best() != 0) first = k;
  }
  LONGS_EQUAL(2, match.best());
  CHECK(first > 45 && first < 80);  // a second and a half after it began to move
}

TEST(WayMatch, OneThatIsSeenFromTheMiddleOfAWindowOnIsMeasuredFromItsNextBeginning) {
  for (int k = 0; k < 50; ++k) {
    robot.drive(0.3, 0);
    match.begin_frame(robot.wheels);
    if (k >= 22) match.add(1, robot.x(0), robot.y(0));  // one whole window, half a second, of 0.15 m
  }
  LONGS_EQUAL(1, match.best());
}

TEST(WayMatch, ManyThatCameAndWentLeaveRoom) {
  for (int id = 1; id <= 40; ++id) {
    match.begin_frame({true, 0, 0, 1.0});
    match.add(id, id, id);
  }
  for (int k = 0; k < 60; ++k) {
    robot.drive(0.2, 0);
    match.begin_frame(robot.wheels);
    match.add(41, robot.x(0), robot.y(0));
  }
  LONGS_EQUAL(41, match.best());
}

TEST(WayMatch, TwoThatGoAlongAreNone) {
  for (int k = 0; k < 100; ++k) {
    robot.drive(0.2, 0);
    match.begin_frame(robot.wheels);
    match.add(1, robot.x(0), robot.y(0));
    match.add(2, 1 - robot.x(0), robot.y(0));
  }
  LONGS_EQUAL(0, match.best());
}

TEST(WayMatch, WheelsThatTurnInPlaceAndSilentOnesSayNothing) {
  for (int k = 0; k < 100; ++k) {
    robot.drive(0, 1.0);
    match.begin_frame(robot.wheels);
    match.add(1, robot.x(0.01), robot.y(0.01));
  }
  LONGS_EQUAL(0, match.best());
  for (int k = 0; k < 100; ++k) {
    robot.drive(0.3, 0);
    match.begin_frame({});
    match.add(1, robot.x(0), robot.y(0));
  }
  LONGS_EQUAL(0, match.best());
}

TEST(WayMatch, ARobotThatIsCarriedAwayIsTheRobotNoMore) {
  for (int k = 0; k < 100; ++k) {
    robot.drive(0.2, 0);
    match.begin_frame(robot.wheels);
    match.add(1, robot.x(0), robot.y(0));
  }
  LONGS_EQUAL(1, match.best());
  for (int k = 0; k < 60; ++k) {
    match.begin_frame({true, 0, 0, kPeriod_s});
    match.add(1, robot.x(0) + 0.02 * k, 0.01 * k);
  }
  LONGS_EQUAL(0, match.best());
}

TEST(WayMatch, ARobotThatIsBackUnderAnotherNumberIsItself) {
  for (int k = 0; k < 300; ++k) {
    robot.drive(0.2, 0.3);
    match.begin_frame(robot.wheels);
    match.add(k < 150 ? 1 : 2, robot.x(0), robot.y(0));
    if (k == 149) LONGS_EQUAL(1, match.best());
  }
  LONGS_EQUAL(2, match.best());
}
