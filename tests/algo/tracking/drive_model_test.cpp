#include "algo/tracking/drive_model.hpp"

#include <CppUTest/TestHarness.h>

#include "algo/core/scalar_math.hpp"

using namespace st;

namespace {

constexpr double kPeriod_s = 1.0 / 30;

// A robot whose axle lies `offset_m` before the tracked origin, and whose forward is at `forward_rad` in the
// object's frame, drives; the object's pose is fed in with a wrong heading if asked.
class Drive {
 public:
  explicit Drive(double forward_rad = 0.7, double offset_m = 0.03)
      : forward_(forward_rad), offset_(offset_m) {}

  void go(double seconds, double v_mps, double w_rps, double wrong_rad = 0, bool doubt = false) {
    for (int i = 0; i < static_cast<int>(seconds / kPeriod_s + 0.5); ++i) {
      const double half = heading_ + 0.5 * w_rps * kPeriod_s;
      const SinCos sc = sin_cos(half);
      x_ += v_mps * kPeriod_s * sc.cos;
      y_ += v_mps * kPeriod_s * sc.sin;
      heading_ += w_rps * kPeriod_s;
      t_ += kPeriod_s;
      model.add(t_, pose(wrong_rad), doubt);
    }
  }
  Pose2 pose(double wrong_rad = 0) const {
    const SinCos sc = sin_cos(heading_);
    return {x_ - offset_ * sc.cos, y_ - offset_ * sc.sin, wrap_angle(heading_ - forward_ + wrong_rad)};
  }
  double expected_error(double wrong_rad = 0) const {
    const ExpectedHeading expected = model.expect(t_ + kPeriod_s, pose(wrong_rad));
    CHECK(expected.known);
    return wrap_angle(expected.yaw_rad - pose().yaw);
  }

  // Somebody carries it elsewhere while nobody sees it.
  void carry(double seconds, double x_m, double y_m, double turn_rad) {
    t_ += seconds, x_ += x_m, y_ += y_m, heading_ += turn_rad;
  }

  DriveModel model;

 private:
  double forward_, offset_, x_ = 0.5, y_ = -0.3, heading_ = 2.8, t_ = 10;
};

}  // namespace

TEST_GROUP(DriveModel){};

TEST(DriveModel, WhatDrivesOnWheelsIsRecognisedAndItsHeadingKnown) {
  Drive robot;
  CHECK_FALSE(robot.model.recognised());
  robot.go(2, 0.2, 0.3);
  CHECK(robot.model.recognised());
  robot.go(1, 0.2, -0.3);
  DOUBLES_EQUAL(0, robot.expected_error(), 0.03);
}

TEST(DriveModel, AHeadingThatDriftsIsFoundOut) {
  Drive robot;
  robot.go(3, 0.2, 0.4);
  robot.go(1, 0.2, 0, 0.3);
  DOUBLES_EQUAL(0, robot.expected_error(0.3), 0.08);
}

TEST(DriveModel, DrivingBackwardsIsNoTurnRound) {
  Drive robot;
  robot.go(3, 0.2, 0.2);
  robot.go(1.5, -0.2, 0);
  DOUBLES_EQUAL(0, robot.expected_error(), 0.03);
}

TEST(DriveModel, WhatIsPushedSidewaysIsNoRobot) {
  DriveModel pushed;
  for (int i = 0; i < 200; ++i) {
    const double t = i * kPeriod_s;
    const SinCos sc = sin_cos(0.9 * t);
    pushed.add(t, {0.2 * sc.cos, 0.2 * sc.sin, 0.0}, false);  // round a circle, never turning
  }
  CHECK_FALSE(pushed.recognised());
}

TEST(DriveModel, StandingAndTurningOnTheSpotTellNoHeading) {
  Drive robot(0.2, 0.0);
  robot.go(3, 0.2, 0);
  robot.go(1.2, 0, 0.9);
  CHECK_FALSE(robot.model.expect(14.3, robot.pose()).known);
}

TEST(DriveModel, NothingIsLearnedFromDoubtAndATurnOfThePastIsNoMotion) {
  Drive robot;
  robot.go(3, 0.2, 0.2);
  robot.go(0.5, 0.2, 0, 0.5, true);
  robot.model.turn_recent(-0.5);
  robot.go(1, 0.2, 0);
  DOUBLES_EQUAL(0, robot.expected_error(), 0.03);
}

TEST(DriveModel, WhereItWasCarriedUnseenIsNoDriving) {
  Drive robot;
  robot.go(3, 0.2, 0.2);
  robot.carry(0.5, 0.1, 0.1, 0);
  robot.go(0.1, 0.2, 0);
  CHECK_FALSE(robot.model.expect(13.7, robot.pose()).known);  // where it came from now, is not known yet
  robot.go(1, 0.2, 0);
  DOUBLES_EQUAL(0, robot.expected_error(), 0.03);
  for (int i = 0; i < 20; ++i) {  // and it is nothing that it does by itself
    robot.carry(0.5, -0.04, 0.07, 0.4);
    robot.go(0.1, 0.2, 0);
  }
  CHECK(robot.model.recognised());
}

TEST(DriveModel, ADoubtThatTheDrivingConfirmsForHalfAMetreEnds) {
  Drive robot;
  robot.go(4, 0.2, 0.2);
  robot.go(4, 0.2, 0.1, 0.6, true);
  CHECK_FALSE(robot.model.recognised());
}

TEST(DriveModel, WhoDrivesAnotherWayForLongIsLearnedAnew) {
  Drive robot;
  robot.go(4, 0.2, 0.2);
  robot.go(4, 0.2, 0.1, 0.6);  // half of it is held for a mistake
  robot.go(3, 0.2, -0.1, 0.6);
  CHECK(robot.model.recognised());
  DOUBLES_EQUAL(0.6, robot.expected_error(0.6), 0.05);
}
