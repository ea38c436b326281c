#include "algo/control/wheel_fit.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <vector>

#include "algo/control/wheel_motion.hpp"
#include "algo/core/scalar_math.hpp"
#include "hal/sim/random.hpp"

using namespace st;

namespace {

constexpr double kSlot_s = 0.005, kBelieved_m = 0.235;

struct Truth {
  double left = 1.01, right = 0.985, base_m = 0.241, lag_s = 0.06;
};

struct Drive {
  std::vector<PlanarSample> base;
  std::vector<WheelMark> marks;
};

// Legs of speed and turn rate as the robot believes them.
Drive drive(const Truth& truth, const std::vector<std::array<double, 3>>& legs, sim::Random& random) {
  Drive d;
  Pose2 pose{0.3, 0.2, 0.5};
  double t = 100, left = 0, right = 0, next_frame_s = t;
  std::vector<std::pair<double, Pose2>> poses;
  for (const auto& [v, w, seconds] : legs)
    for (double s = 0; s < seconds; s += kSlot_s) {
      const double dl = (v - 0.5 * w * kBelieved_m) * kSlot_s, dr = (v + 0.5 * w * kBelieved_m) * kSlot_s;
      left += dl, right += dr, t += kSlot_s;
      pose = advanced(pose, 0.5 * (truth.left * dl + truth.right * dr),
                      (truth.right * dr - truth.left * dl) / truth.base_m);
      d.marks.push_back({t, left, right});
      if (t < next_frame_s) continue;
      next_frame_s += 1 / 30.0;
      d.base.push_back({t + truth.lag_s, pose.x + 0.001 * random.normal(), pose.y + 0.001 * random.normal(),
                        pose.yaw + 0.005 * random.normal()});
    }
  return d;
}

std::vector<std::array<double, 3>> square(double direction) {
  std::vector<std::array<double, 3>> legs{{0, 0, 1}};
  for (int i = 0; i < 4; ++i) {
    legs.push_back({0.2, 0, 5});
    legs.push_back({0, 0, 0.5});
    legs.push_back({0, direction * 0.8, kPi / 2 / 0.8});
    legs.push_back({0, 0, 0.5});
  }
  return legs;
}

WheelFit fit_of(const Drive& d) {
  std::vector<FitWindow> memory(kFitWindows);
  return fit_wheels(d.base, d.marks, memory);
}

}  // namespace

TEST_GROUP(WheelFit) {
  sim::Random random{3};
  Truth truth;
};

TEST(WheelFit, ASquareTellsBothWheelsTheBaseAndTheLag) {
  for (const double direction : {1.0, -1.0}) {
    const WheelFit fit = fit_of(drive(truth, square(direction), random));
    CHECK(fit.valid);
    DOUBLES_EQUAL(truth.left, fit.left_scale, 0.004);
    DOUBLES_EQUAL(truth.right, fit.right_scale, 0.004);
    DOUBLES_EQUAL(truth.right / truth.left, fit.right_scale / fit.left_scale, 0.0015);
    DOUBLES_EQUAL(truth.base_m, fit.wheel_base_m, 0.0015);
    DOUBLES_EQUAL(truth.lag_s, fit.lag_s, 0.01);
    CHECK(std::fabs(fit.right_scale - truth.right) < 5 * fit.sigma_scale + 0.002);
  }
}

TEST(WheelFit, AHeadingThatIsWrongForAWhileDoesNotSpoilIt) {
  Drive d = drive(truth, square(1), random);
  for (std::size_t i = 200; i < 240; ++i) d.base[i].yaw_rad += 0.1 * static_cast<double>(i - 199);
  const WheelFit fit = fit_of(d);
  CHECK(fit.valid);
  DOUBLES_EQUAL(truth.right / truth.left, fit.right_scale / fit.left_scale, 0.003);
  DOUBLES_EQUAL(truth.base_m, fit.wheel_base_m, 0.003);
}

TEST(WheelFit, WhatTellsNotEnoughIsRefused) {
  CHECK_FALSE(fit_of(drive(truth, {{0, 0, 10}}, random)).valid);    // it stood
  CHECK_FALSE(fit_of(drive(truth, {{0.2, 0, 5}}, random)).valid);   // straight on only
  CHECK_FALSE(fit_of(drive(truth, {{0, 0.5, 10}}, random)).valid);  // on the spot only
  Drive silent = drive(truth, square(1), random);
  silent.marks.clear();
  CHECK_FALSE(fit_of(silent).valid);
}
