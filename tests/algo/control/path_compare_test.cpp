#include "algo/control/path_compare.hpp"

#include <CppUTest/TestHarness.h>

#include <vector>

#include "tests/support/robot_motion.hpp"

using namespace st;

namespace {

constexpr double kDeg = kPi / 180.0;

}  // namespace

TEST_GROUP(PathCompare) {
  std::vector<PathError> placed, shaped;

  PathComparison compare(const std::vector<PathSample>& path, const std::vector<PlanarSample>& base) {
    std::vector<Point2> scratch(base.size() + 16);
    placed.assign(base.size(), {});
    shaped.assign(base.size(), {});
    return compare_path(path, base, placed, shaped, scratch);
  }
  static std::vector<PathSample> path_of(const MotionScript& script) {
    std::vector<PathSample> path;
    for (const BaseSampleTruth& s : script.samples())
      path.push_back({s.t_s, s.pose.x, s.pose.y, s.pose.yaw, 0, 0});
    return path;
  }
  static std::vector<PlanarSample> base_of(const MotionScript& script, double noise_m = 0,
                                           double noise_rad = 0, unsigned seed = 1) {
    return seen_object(script.samples(), {}, noise_m, noise_rad, seed);
  }
  static MotionScript circle(double radius_m, Pose2 start = {}) {
    MotionScript script(start);
    script.drive(0, 0, 1).drive(0.2, 0.2 / radius_m, 2 * kPi * radius_m / 0.2).drive(0, 0, 1);
    return script;
  }
  static MotionScript square(Pose2 start = {}, double side_m = 1) {
    MotionScript script(start);
    script.drive(0, 0, 1);
    for (int i = 0; i < 4; ++i) script.drive(0.2, 0, side_m / 0.2).drive(0, kPi / 4, 2);
    return script;
  }
};

TEST(PathCompare, WhatDrivesThePathExactlyHasNoError) {
  const Pose2 start{1, 2, 2.5};
  for (const auto& [path, base] :
       {std::pair{square(), square(start)}, std::pair{circle(0.5), circle(0.5, start)}}) {
    const PathComparison c = compare(path_of(path), base_of(base));
    CHECK(c.valid);
    DOUBLES_EQUAL(0, c.as_placed.rmse_m, 1e-4);
    DOUBLES_EQUAL(0, c.shape.rmse_m, 1e-4);
    DOUBLES_EQUAL(0, c.as_placed.heading_rmse_rad, 0.01);
    DOUBLES_EQUAL(1, c.as_placed.in_band, 0);
    DOUBLES_EQUAL(start.x, c.as_placed.T_floor_path.x, 1e-9);
    DOUBLES_EQUAL(start.yaw, c.as_placed.T_floor_path.yaw, 1e-9);
  }
}

// A start that is turned by 5 degrees shows as placed, and not by shape.
TEST(PathCompare, AWrongStartIsFittedOutOfTheShape) {
  std::vector<PlanarSample> base = base_of(square({1, 2, 0.7}));
  const Pose2 truth = first_pose(base);
  for (std::size_t i = 0; i < base.size() && base[i].t_s < 0.9; ++i) base[i].yaw_rad += 5 * kDeg;
  const PathComparison c = compare(path_of(square()), base);
  CHECK(c.as_placed.rmse_m > 0.03);
  DOUBLES_EQUAL(0, c.shape.rmse_m, 1e-3);
  DOUBLES_EQUAL(truth.x, c.shape.T_floor_path.x, 2e-3);
  DOUBLES_EQUAL(truth.y, c.shape.T_floor_path.y, 2e-3);
  DOUBLES_EQUAL(truth.yaw, c.shape.T_floor_path.yaw, 0.2 * kDeg);
}

// A larger circle that touches the preset one where both start lies 2 e sin^2(a/2) beside it, root mean
// square e * sqrt(3/2).
TEST(PathCompare, AKnownRadiusErrorIsFoundExactly) {
  const double e = 0.03;
  const PathComparison c = compare(path_of(circle(0.5)), base_of(circle(0.5 + e, {3, 1, -2})));
  CHECK(c.is_circle);
  DOUBLES_EQUAL(0.5, c.preset_circle.radius_m, 1e-4);
  DOUBLES_EQUAL(0.5 + e, c.driven_circle.radius_m, 1e-4);
  DOUBLES_EQUAL(e * 1.2247, c.as_placed.rmse_m, 1.5e-3);
  DOUBLES_EQUAL(2 * e, c.as_placed.max_m, 1.5e-3);
  DOUBLES_EQUAL(e, c.shape.rmse_m, 1e-3);
  // It runs outside a path that turns left, so to the right of it.
  CHECK(placed[c.count / 2].offset_m < -0.04);
  CHECK(c.as_placed.in_band < 0.9);
}

TEST(PathCompare, NoiseOfATrackerLeavesTheRadiusWithinAMillimetre) {
  const PathComparison c =
      compare(path_of(circle(0.5)), base_of(circle(0.52, {1, 1, 1}), 0.003, 0.7 * kDeg, 5));
  DOUBLES_EQUAL(0.52, c.driven_circle.radius_m, 0.001);
  DOUBLES_EQUAL(0.02 * 1.2247, c.as_placed.rmse_m, 0.004);
}

TEST(PathCompare, ALateStartAndASlowRobotAreNotBesideThePath) {
  MotionScript slow({0, 0, 1});
  slow.drive(0, 0, 6);
  for (int i = 0; i < 4; ++i) slow.drive(0.15, 0, 1 / 0.15).drive(0, kPi / 6, 3);
  slow.drive(0, 0, 10);
  const PathComparison c = compare(path_of(square()), base_of(slow));
  DOUBLES_EQUAL(0, c.as_placed.rmse_m, 1e-3);
  DOUBLES_EQUAL(0, c.as_placed.heading_rmse_rad, 0.01);
  // Standing before and after does not water the errors down.
  CHECK(static_cast<double>(c.count) < 30 * (4 * (1 / 0.15 + 3) + 1));
}

TEST(PathCompare, LapsAndCrossingsAreFollowedInTheirOrder) {
  MotionScript eight, drifting({0, 0, 0});
  for (int lap = 0; lap < 2; ++lap) {
    eight.drive(0.2, 0.4, 5 * kPi).drive(0.2, -0.4, 5 * kPi);
    drifting.drive(0.2, 0.402, 5 * kPi).drive(0.2, -0.398, 5 * kPi);
  }
  const PathComparison c = compare(path_of(eight), base_of(drifting));
  CHECK(c.as_placed.rmse_m < 0.05);
  CHECK(c.as_placed.heading_rmse_rad < 0.15);
  DOUBLES_EQUAL(path_of(eight).back().t_s, placed[c.count - 1].path_t_s, 0.5);
}

TEST(PathCompare, AHeadingErrorOnALineGrowsSideways) {
  MotionScript line, veering;
  line.drive(0, 0, 1).drive(0.2, 0, 10);
  // It stands straight, turns 2 degrees on the spot, then drives on.
  veering.drive(0, 0, 1).drive(0, 2 * kDeg, 1).drive(0.2, 0, 10);
  const PathComparison c = compare(path_of(line), base_of(veering));
  DOUBLES_EQUAL(2.0 * sin_cos(2 * kDeg).sin, c.as_placed.max_m, 3e-3);
  DOUBLES_EQUAL(2 * kDeg, c.as_placed.heading_rmse_rad, 0.1 * kDeg);
  DOUBLES_EQUAL(0, c.shape.rmse_m, 2e-3);
}

TEST(PathCompare, StoppingShortOrRunningOverTheEndCounts) {
  MotionScript line, over;
  line.drive(0.2, 0, 5);
  over.drive(0.2, 0, 6);
  const PathComparison c = compare(path_of(line), base_of(over));
  DOUBLES_EQUAL(0.2, c.as_placed.max_m, 0.01);
}

TEST(PathCompare, DrivingOnRoundAClosedPathIsNotBesideIt) {
  MotionScript over({1, 1, 0.5});
  over.drive(0, 0, 1).drive(0.2, 0.4, 1.1 * 5 * kPi).drive(0, 0, 1);
  const PathComparison c = compare(path_of(circle(0.5)), base_of(over));
  DOUBLES_EQUAL(0, c.as_placed.max_m, 1e-3);
  DOUBLES_EQUAL(0, c.shape.max_m, 1e-3);
}

TEST(PathCompare, NothingThatMovesIsNoComparison) {
  MotionScript standing;
  standing.drive(0, 0, 5);
  CHECK_FALSE(compare(path_of(square()), base_of(standing, 0.003, 0.7 * kDeg)).valid);
  CHECK_FALSE(compare({}, base_of(square())).valid);
  CHECK_FALSE(compare(path_of(square()), {}).valid);
}

TEST_GROUP(CircleFit){};

TEST(CircleFit, AnArcWithNoiseGivesItsCircle) {
  std::vector<Point2> points;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.002);
  for (int i = 0; i < 200; ++i) {
    const SinCos a = sin_cos(0.01 * i);
    points.push_back({3 + 0.7 * a.cos + noise(random), -2 + 0.7 * a.sin + noise(random)});
  }
  const CircleFit fit = fit_circle(points);
  DOUBLES_EQUAL(0.7, fit.radius_m, 0.003);
  DOUBLES_EQUAL(3, fit.x_m, 0.003);
  DOUBLES_EQUAL(-2, fit.y_m, 0.003);
  DOUBLES_EQUAL(0.002, fit.rms_m, 0.0004);
}

TEST(CircleFit, PointsOnALineHaveNone) {
  std::vector<Point2> points;
  for (int i = 0; i < 20; ++i) points.push_back({0.1 * i, 0.2 * i});
  CHECK_FALSE(fit_circle(points).valid);
  CHECK_FALSE(fit_circle(std::vector<Point2>{{0, 0}, {1, 1}}).valid);
}
