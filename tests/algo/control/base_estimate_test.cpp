#include "algo/control/base_estimate.hpp"

#include <CppUTest/TestHarness.h>

#include <fstream>
#include <iterator>

#include "hal/results/tum_file.hpp"
#include "tests/support/recordings.hpp"

#include "tests/support/robot_motion.hpp"

using namespace st;

namespace {

constexpr double kDeg = kPi / 180.0;
constexpr double kNoiseM = 0.003, kNoiseRad = 0.7 * kDeg;
// An object frame as the first segmentation would leave it: well off the turning centre, and turned.
constexpr Pose2 kBase{0.041, -0.027, 2.1};

}  // namespace

TEST_GROUP(BaseEstimate) {
  std::vector<BaseWindow> windows = std::vector<BaseWindow>(kBaseWindows);

  BaseEstimate estimate(const std::vector<PlanarSample>& samples, const BasePrior& prior = {}) {
    return estimate_base(samples, prior, windows);
  }
  static double position_error(const BaseEstimate& e, const Pose2& base) {
    return std::hypot(e.x_m - base.x, e.y_m - base.y);
  }
  static double yaw_error(const BaseEstimate& e, const Pose2& base) {
    return std::fabs(wrap_angle(e.yaw_rad - base.yaw));
  }
  static MotionScript square(double v = 0.2, double w = 0.8, double side_m = 0.8) {
    MotionScript script({1, 2, 0.3});
    script.drive(0, 0, 1);
    for (int i = 0; i < 4; ++i) script.drive(v, 0, side_m / v).drive(0, w, 0.5 * kPi / w);
    return script;
  }
  // The worst over seeds: a lucky one proves nothing.
  void worst(const MotionScript& script, const BasePrior& prior, double& error_m, double& error_rad) {
    error_m = error_rad = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const BaseEstimate e = estimate(seen_object(script.samples(), kBase, kNoiseM, kNoiseRad, seed), prior);
      CHECK(e.differential_drive);
      error_m = std::max(error_m, position_error(e, kBase));
      error_rad = std::max(error_rad, yaw_error(e, kBase));
      CHECK(position_error(e, kBase) < 4 * e.sigma_m);
      CHECK(yaw_error(e, kBase) < 4 * e.sigma_rad);
    }
  }
};

TEST(BaseEstimate, ASquareWithoutNoiseGivesTheBaseExactly) {
  const BaseEstimate e = estimate(seen_object(square().samples(), kBase, 0, 0, 1));
  CHECK(e.differential_drive);
  DOUBLES_EQUAL(0, position_error(e, kBase), 3e-4);
  DOUBLES_EQUAL(0, yaw_error(e, kBase), 0.03 * kDeg);
  DOUBLES_EQUAL(2 * kPi, e.spot_turn_rad, 1.2);
}

TEST(BaseEstimate, ASquareWithTurnsOnTheSpotGivesItWithinTwoMillimetres) {
  double error_m = 0, error_rad = 0;
  worst(square(), {}, error_m, error_rad);
  CHECK(error_m < 0.002);
  CHECK(error_rad < 0.2 * kDeg);
}

TEST(BaseEstimate, OnACircleTheShapeSaysWhatTheMotionCannot) {
  MotionScript circle({1, 2, 0.3});
  circle.drive(0.2, 0.4, 16);
  double error_m = 0, error_rad = 0;
  // The prior itself is 1.5 mm off.
  worst(circle, {kBase.x + 0.001, kBase.y + 0.001, 0.003, 0.003}, error_m, error_rad);
  CHECK(error_m < 0.0025);
  CHECK(error_rad < 0.3 * kDeg);
}

TEST(BaseEstimate, OnACircleWithoutKnownShapeTheSigmaIsHonest) {
  MotionScript circle;
  circle.drive(0.2, 0.4, 16);
  const BaseEstimate e = estimate(seen_object(circle.samples(), kBase, kNoiseM, kNoiseRad, 3));
  CHECK(e.sigma_m > 0.03);
  CHECK(position_error(e, kBase) < 3 * e.sigma_m);
}

TEST(BaseEstimate, AFigureEightGivesDirectionAndForwardPosition) {
  MotionScript eight;
  eight.drive(0.2, 0.5, 12.6).drive(0.2, -0.5, 12.6);
  const BaseEstimate e =
      estimate(seen_object(eight.samples(), kBase, kNoiseM, kNoiseRad, 2), {kBase.x, kBase.y, 0.05, 0.003});
  CHECK(e.differential_drive);
  DOUBLES_EQUAL(0, yaw_error(e, kBase), 0.5 * kDeg);
  DOUBLES_EQUAL(0, position_error(e, kBase), 0.005);
}

TEST(BaseEstimate, ALineGivesTheDirectionAndLeavesTheCentreToThePrior) {
  MotionScript line;
  line.drive(0, 0, 1).drive(0.2, 0, 8).drive(0, 0, 1);
  const BaseEstimate e = estimate(seen_object(line.samples(), kBase, kNoiseM, kNoiseRad, 4));
  CHECK(e.differential_drive);
  DOUBLES_EQUAL(0, yaw_error(e, kBase), 0.3 * kDeg);
  CHECK(e.sigma_m > 0.04);
  DOUBLES_EQUAL(0, e.x_m, 0.05);
}

TEST(BaseEstimate, ForwardIsWhereItMostlyDrives) {
  MotionScript script;
  script.drive(0.2, 0, 5).drive(-0.2, 0, 2).drive(0, 0.8, 2).drive(0.2, 0, 5);
  const BaseEstimate e = estimate(seen_object(script.samples(), kBase, kNoiseM, kNoiseRad, 5));
  DOUBLES_EQUAL(0, yaw_error(e, kBase), 0.5 * kDeg);
}

TEST(BaseEstimate, OnlyTurningLeavesTheDirectionOpen) {
  MotionScript script;
  script.drive(0, 0.8, 20);
  CHECK_FALSE(estimate(seen_object(script.samples(), kBase, kNoiseM, kNoiseRad, 6)).differential_drive);
}

TEST(BaseEstimate, WhatStandsStillIsNoRobot) {
  MotionScript script;
  script.drive(0, 0, 30);
  CHECK_FALSE(estimate(seen_object(script.samples(), kBase, kNoiseM, kNoiseRad, 7)).differential_drive);
}

TEST(BaseEstimate, AnObjectPushedByHandIsRecognisedAsNoRobot) {
  // Shoved about: the place goes round a wide curve while the object turns as it likes.
  std::vector<PlanarSample> pushed;
  for (int i = 0; i < 300; ++i) {
    const double t = i / 30.0;
    const SinCos a = sin_cos(0.7 * t), b = sin_cos(1.3 * t + 1);
    pushed.push_back({t, 0.4 * a.cos + 0.1 * b.sin, 0.3 * a.sin, 0.5 * b.cos});
  }
  CHECK_FALSE(estimate(pushed).differential_drive);
}

TEST(BaseEstimate, AGapAndAJumpDoNotSpoilIt) {
  std::vector<PlanarSample> seen = seen_object(square().samples(), kBase, kNoiseM, kNoiseRad, 8);
  seen.erase(seen.begin() + 200, seen.begin() + 230);  // lost for a second, while it moved
  for (std::size_t i = 300; i < 303; ++i) seen[i].x_m += 0.05, seen[i].yaw_rad += 0.1;
  const BaseEstimate e = estimate(seen);
  CHECK(e.differential_drive);
  DOUBLES_EQUAL(0, position_error(e, kBase), 0.005);
  DOUBLES_EQUAL(0, yaw_error(e, kBase), 0.5 * kDeg);
}

TEST(BaseEstimate, NoSamplesOrOneAreNoRobot) {
  CHECK_FALSE(estimate({}).differential_drive);
  CHECK_FALSE(estimate({{1, 2, 3, 4}}).differential_drive);
}

// The true motion of another simulator's robot, with the noise of a tracker, seen through an object frame of
// its own.
TEST(BaseEstimate, TheTruthOfARecordingGivesItsBase) {
  const std::string path = recording_file("lab-square/truth.tum");
  if (path.empty()) return;
  std::ifstream file(path);
  const TumTrajectory truth = parse_tum(std::string(std::istreambuf_iterator<char>(file), {}));
  const Pose T_floor_camera = truth.poses.front().T.inverse();
  std::vector<BaseSampleTruth> base;
  for (const TumPose& pose : truth.poses) {
    const Pose T = T_floor_camera * pose.T;
    base.push_back({pose.t_s, {T.t.x, T.t.y, to_roll_pitch_yaw(T.R).z}});
  }
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const BaseEstimate e = estimate(seen_object(base, kBase, kNoiseM, kNoiseRad, seed));
    CHECK(e.differential_drive);
    DOUBLES_EQUAL(0, position_error(e, kBase), 0.002);
    DOUBLES_EQUAL(0, yaw_error(e, kBase), 0.2 * kDeg);
  }
}

TEST(BaseEstimate, WhoDrivesThereAndBackLooksThere) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    MotionScript script({1, 2, 0.3});
    script.drive(0, 0, 1).drive(0.3, 0, 3).drive(0, 0, 1).drive(-0.3, 0, 3.02).drive(0, 0, 1);
    const BaseEstimate e = estimate(seen_object(script.samples(), kBase, kNoiseM, kNoiseRad, seed));
    CHECK(yaw_error(e, kBase) < 10 * kDeg);
  }
}
