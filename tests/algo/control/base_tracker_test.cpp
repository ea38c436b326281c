// Which places and headings of the tracked object the base's filter believes.
#include "algo/control/base_tracker.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "tests/algo/control/obedient_robot.hpp"

using namespace st;
using namespace st::test;

TEST_GROUP(BaseTracker) {
  sim::Random random{7};
  Robot robot;
};

TEST(BaseTracker, AJumpOfThePoseIsNotFollowedAtOnce) {
  const Obedience o = start(robot, random, 0, kNobodyElse);
  BaseTracker tracker;
  tracker.start(o, seen(1, robot.pose, random).pose);
  SeenObject wrong = seen(1, robot.pose, random);
  wrong.pose.x += 0.5;
  const Pose2 before = tracker.base();
  tracker.update(odometry({}, kFrame_s), 0, 0, &wrong);
  CHECK_FALSE(tracker.seen());
  DOUBLES_EQUAL(before.x, tracker.base().x, 1e-9);
  for (int i = 0; i < 30; ++i) tracker.update(odometry({}, kFrame_s), 0, 0, &wrong);
  CHECK(tracker.seen());  // it stays there: somebody carried the robot
  DOUBLES_EQUAL(before.x + 0.5, tracker.base().x, 0.01);
}

// A tracker that has lost the robot and finds it somewhere else in every frame: none of that is it.
TEST(BaseTracker, PlacesThatDoNotAgreeAreNeverBelieved) {
  const Obedience o = start(robot, random, 0, kNobodyElse);
  for (const bool two_places : {false, true}) {
    BaseTracker tracker;
    tracker.start(o, seen(1, robot.pose, random).pose);
    const Pose2 before = tracker.base();
    for (int i = 0; i < 300; ++i) {
      SeenObject wrong = seen(1, robot.pose, random);
      const double angle = two_places ? i % 2 * kPi : 2 * kPi * random.uniform();
      const double away_m = two_places ? 0.3 : 0.2 + random.uniform();
      wrong.pose.x += away_m * std::cos(angle);
      wrong.pose.y += away_m * std::sin(angle);
      tracker.update(odometry({}, kFrame_s), 0, 0, &wrong);
      CHECK_FALSE(tracker.seen());
    }
    DOUBLES_EQUAL(before.x, tracker.base().x, 1e-9);
    DOUBLES_EQUAL(before.y, tracker.base().y, 1e-9);
  }
}

// Carried away while it drives on: the places agree once the wheels' way is taken off.
TEST(BaseTracker, ARobotThatWasCarriedIsFoundWhileItDrives) {
  const Obedience o = start(robot, random, 0, kNobodyElse);
  BaseTracker tracker;
  tracker.start(o, seen(1, robot.pose, random).pose);
  robot.pose.y += 0.4;
  const WheelSpeeds told = wheel_speeds(0.4, 0, kBase_m);
  for (int i = 0; i < 20; ++i) {
    robot.roll(told, kFrame_s);
    const SeenObject object = seen(1, robot.pose, random);
    tracker.update(odometry(told, kFrame_s), 0, 0, &object);
    CHECK_EQUAL(i >= 15, tracker.seen());
  }
  DOUBLES_EQUAL(robot.pose.x, tracker.base().x, 0.01);
  DOUBLES_EQUAL(robot.pose.y, tracker.base().y, 0.01);
}

// The tracker holds on to something that stands: it is where it was, but not where the robot drives.
TEST(BaseTracker, AThingThatStandsIsNotTheRobotThatDrives) {
  const Obedience o = start(robot, random, 0, kNobodyElse);
  BaseTracker tracker;
  tracker.start(o, seen(1, robot.pose, random).pose);
  Pose2 chair = robot.pose;
  chair.y += 0.4;
  const WheelSpeeds told = wheel_speeds(0.2, 0, kBase_m);
  for (int i = 0; i < 60; ++i) {
    const SeenObject wrong = seen(1, chair, random);
    tracker.update(odometry(told, kFrame_s), 0, 0, &wrong);
    CHECK_FALSE(tracker.seen());
  }
}

TEST(BaseTracker, APlaceThatIsWrongInOneCoordinateCorrectsNeither) {
  const Obedience o = start(robot, random, 0, kNobodyElse);
  BaseTracker tracker;
  tracker.start(o, seen(1, robot.pose, random).pose);
  const Pose2 before = tracker.base();
  for (const bool in_y : {false, true}) {
    SeenObject wrong = seen(1, robot.pose, random);
    wrong.pose.x += in_y ? 0.02 : 0.5;
    wrong.pose.y += in_y ? 0.5 : 0.02;
    tracker.update(odometry({}, kFrame_s), 0, 0, &wrong);
    CHECK_FALSE(tracker.seen());
    DOUBLES_EQUAL(before.x, tracker.base().x, 1e-9);
    DOUBLES_EQUAL(before.y, tracker.base().y, 1e-9);
  }
}

// What a tracker does on a round robot without a print: places are right, headings slide away.
TEST(BaseTracker, AHeadingThatSlidesIsLeftOut) {
  const Obedience o = start(robot, random, 0, kNobodyElse);
  BaseTracker tracker;
  tracker.start(o, seen(1, robot.pose, random).pose);
  const WheelSpeeds told = wheel_speeds(0.2, 0.4, kBase_m);
  double slide = 0, worst_m = 0, worst_rad = 0;
  for (int i = 0; i < 400; ++i) {
    robot.roll(told, kFrame_s);
    if (i > 150 && i < 200) slide += 0.05;
    if (i == 250) slide = 0;
    SeenObject object = seen(1, robot.pose, random);
    object.pose.yaw += slide;
    tracker.update(odometry(told, kFrame_s), 0, 0, &object);
    CHECK(tracker.seen());
    const Pose2 at = tracker.base();
    worst_m = std::max(worst_m, std::hypot(at.x - robot.pose.x, at.y - robot.pose.y));
    worst_rad = std::max(worst_rad, std::fabs(wrap_angle(at.yaw - robot.pose.yaw)));
  }
  CHECK(worst_m < 0.015);
  CHECK(worst_rad < 0.12);
}
