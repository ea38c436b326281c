#include "algo/tracking/motion_filter.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

#include "algo/core/scalar_math.hpp"

using namespace st;

namespace {

constexpr double kPeriod_s = 1.0 / 30;

struct Covariance {
  double m[36]{};
  Covariance(double sigma_m, double sigma_rad) {
    for (int i = 0; i < 6; ++i) m[7 * i] = i < 3 ? sigma_m * sigma_m : sigma_rad * sigma_rad;
  }
};
const Covariance kSure{1e-5, 1e-5};

// Camera that looks along the floor's y axis, slightly down.
const Mat3 kFloorFromCamera = rotation_from_vector({-kPi / 2 - 0.3, 0, 0});

// Drives straight and turns at constant rates, in floor axes.
Pose truth(double t_s) {
  const Mat3 R = kFloorFromCamera.transposed();
  return {R * rotation_z(0.5 * t_s), Vec3{0.1, 0.2, 1.5} + R * Vec3{0.2 * t_s, 0.1 * t_s, 0}};
}

double error_m(const Pose& a, const Pose& b) { return norm(a.t - b.t); }
double error_rad(const Pose& a, const Pose& b) { return rotation_angle(a.R.transposed() * b.R); }

// Feeds true poses for so many frames; the filter then stands at frame `frames`, corrected.
MotionFilter after(int frames, const Covariance& covariance = kSure) {
  MotionFilter filter;
  filter.start(truth(0), kFloorFromCamera, 0);
  for (int k = 1; k <= frames; ++k) {
    filter.predict(k * kPeriod_s, {});
    filter.correct(truth(k * kPeriod_s), covariance.m);
  }
  return filter;
}

}  // namespace

TEST_GROUP(MotionFilter){};

TEST(MotionFilter, StartsAtRest) {
  MotionFilter filter;
  filter.start(truth(0), kFloorFromCamera, 10);
  filter.predict(10.5, {});
  DOUBLES_EQUAL(0, error_m(truth(0), filter.pose()), 1e-12);
  DOUBLES_EQUAL(10.5, filter.t_s(), 0);
}

TEST(MotionFilter, ConstantVelocityIsPredicted) {
  MotionFilter filter = after(12);
  DOUBLES_EQUAL(0.2, filter.velocity_mps().x, 0.01);
  DOUBLES_EQUAL(0.1, filter.velocity_mps().y, 0.01);
  DOUBLES_EQUAL(0.5, filter.angular_velocity_rps().z, 0.02);
  filter.predict(15 * kPeriod_s, {});  // three frames ahead at once
  DOUBLES_EQUAL(0, error_m(truth(15 * kPeriod_s), filter.pose()), 0.002);
  DOUBLES_EQUAL(0, error_rad(truth(15 * kPeriod_s), filter.pose()), 0.004);
}

TEST(MotionFilter, MotionOverTakesPointsAlong) {
  const MotionFilter filter = after(12);
  const Pose step = filter.motion_over(0.02);
  const Pose there = step * filter.pose();
  DOUBLES_EQUAL(0, error_m(truth(12 * kPeriod_s + 0.02), there), 5e-4);
  const Pose back = filter.motion_over(-0.02) * filter.pose();
  DOUBLES_EQUAL(0, error_m(truth(12 * kPeriod_s - 0.02), back), 5e-4);
}

TEST(MotionFilter, UncertaintyGrowsWithTimeAndShrinksWithAPose) {
  MotionFilter filter = after(5);
  const double known = filter.position_sigma_m();
  filter.predict(filter.t_s() + kPeriod_s, {});
  const double soon = filter.position_sigma_m();
  filter.predict(filter.t_s() + 5 * kPeriod_s, {});
  const double later = filter.position_sigma_m();
  CHECK(known < soon && soon < later);
  filter.correct(truth(filter.t_s()), kSure.m);
  CHECK(filter.position_sigma_m() < soon);
}

TEST(MotionFilter, CovarianceIsTheInverseOfThePriorsInformation) {
  MotionFilter filter = after(5, {1e-3, 3e-3});
  filter.predict(filter.t_s() + kPeriod_s, {});
  double covariance[36];
  filter.covariance(covariance);
  const MotionPrior prior = filter.prior();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      double product = 0;
      for (int k = 0; k < 6; ++k) product += covariance[6 * i + k] * prior.information[6 * k + j];
      DOUBLES_EQUAL(i == j ? 1 : 0, product, 1e-9);
    }
}

TEST(MotionFilter, RatesFollowAPoseByAsMuchAsItIsSure) {
  // One frame with the same surprise, seen sharply and hardly.
  const auto rate_after = [](double sigma_m) {
    MotionFilter filter = after(5);
    filter.predict(6 * kPeriod_s, {});
    Pose surprise = filter.pose();
    surprise.t += Vec3{0.01, 0, 0};
    // The posterior of a pose that the prior, too, had a say in: its shift is smaller by the same share.
    const double prior = 1 / filter.prior().information[0], share = prior / (prior + sigma_m * sigma_m);
    surprise.t = filter.pose().t + (surprise.t - filter.pose().t) * share;
    const double posterior = prior * sigma_m * sigma_m / (prior + sigma_m * sigma_m);
    Covariance covariance{1e-5, 1e-5};
    covariance.m[0] = posterior;
    const double before = (kFloorFromCamera.transposed() * filter.velocity_mps()).x;
    filter.correct(surprise, covariance.m);
    return (kFloorFromCamera.transposed() * filter.velocity_mps()).x - before;
  };
  const double sharp = rate_after(1e-4), vague = rate_after(0.05);
  CHECK(sharp > 0.02);  // 10 mm in a frame are 0.3 m/s, damped by what the filter knew
  CHECK(vague > 0 && vague < 0.2 * sharp);
}

TEST(MotionFilter, ThePriorIsThatOfTheAxesTheFilterWorksIn) {
  MotionFilter filter = after(5, Covariance{1e-4, 1e-3});
  filter.predict(6 * kPeriod_s, {});
  const MotionPrior prior = filter.prior();
  DOUBLES_EQUAL(0, error_m(prior.mean, filter.pose()), 0);
  for (int i = 0; i < 6; ++i) {
    CHECK(prior.information[7 * i] > 0);
    for (int j = 0; j < i; ++j)
      DOUBLES_EQUAL(prior.information[6 * i + j], prior.information[6 * j + i], 1e-6);
  }
  DOUBLES_EQUAL(0, prior.information[3], 0);  // turn and place apart
}

TEST(MotionFilter, WhatLeavesThePlaneMayRiseAndLeanButKeepsItsWay) {
  MotionFilter filter = after(30, Covariance{1e-5, 1e-3});
  const Vec3 velocity = filter.velocity_mps();
  const MotionPrior held = filter.prior();
  filter.leave_plane();
  const MotionPrior left = filter.prior();
  // About the floor's axes, in which the filter works: rows of the rotation into them.
  const auto about = [](const MotionPrior& prior, int axis) {
    double sum = 0;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        sum += kFloorFromCamera(axis % 3, r) * prior.information[6 * (axis / 3 * 3 + r) + axis / 3 * 3 + c] *
               kFloorFromCamera(axis % 3, c);
    return sum;
  };
  for (const int i : {2, 3, 4}) CHECK(about(left, i) < 0.2 * about(held, i));
  for (const int i : {0, 1, 5}) DOUBLES_EQUAL(about(held, i), about(left, i), 1e-6 * about(held, i));
  DOUBLES_EQUAL(velocity.x, filter.velocity_mps().x, 0);
}

TEST(MotionFilter, ACorrectedMistakeIsNoMotion) {
  MotionFilter filter = after(30);
  const Vec3 rates = filter.angular_velocity_rps(), out = filter.output().angular_velocity_rps;
  const Mat3 by = rotation_from_vector({0.1, 0.3, -0.2});
  filter.turn(by);
  DOUBLES_EQUAL(0, rotation_angle(filter.pose().R * (by * truth(30 * kPeriod_s).R).transposed()), 1e-3);
  filter.predict(31 * kPeriod_s, {});
  filter.correct({by * truth(31 * kPeriod_s).R, truth(31 * kPeriod_s).t}, kSure.m);
  DOUBLES_EQUAL(0, norm(filter.angular_velocity_rps() - rates),
                0.35);  // the axis of its turn was turned, too
  DOUBLES_EQUAL(0, norm(filter.output().angular_velocity_rps - out), 0.35);
}

TEST(MotionFilter, AGapOfAnyLengthLeavesItsUncertaintySound) {
  const Covariance usual{1e-3, 3e-3};
  for (const double gap_s : {0.5, 2.0, 10.0, 600.0}) {
    MotionFilter filter = after(12, usual);
    double t_s = 12 * kPeriod_s + gap_s;
    for (int k = 0; k < 30; ++k, t_s += kPeriod_s) {
      filter.predict(t_s, {});
      const MotionPrior prior = filter.prior();
      for (int i = 0; i < 6; ++i)
        CHECK(prior.information[7 * i] > 0 && std::isfinite(prior.information[7 * i]));
      CHECK(filter.position_sigma_m() > 0);
      filter.correct(truth(0), usual.m);
    }
    DOUBLES_EQUAL(0, norm(filter.velocity_mps()), 0.05);
  }
}

TEST(MotionFilter, CoastingFadesAndRestStops) {
  MotionFilter filter = after(12);
  filter.coast(0.5);
  DOUBLES_EQUAL(0.1, filter.velocity_mps().x, 0.01);
  filter.rest();
  filter.predict(1.0, {});
  DOUBLES_EQUAL(0, error_m(truth(12 * kPeriod_s), filter.pose()), 1e-12);
}

TEST(MotionFilter, PublishedRatesSettleOnTheTruth) {
  const MotionFilter filter = after(40);
  DOUBLES_EQUAL(0.2, filter.output().velocity_mps.x, 0.002);
  DOUBLES_EQUAL(0.5, filter.output().angular_velocity_rps.z, 0.005);
  DOUBLES_EQUAL(0, filter.output().acceleration_mps2.x, 0.03);
}

TEST(MotionFilter, AColourImageOfTheSameInstantIsTiedFirmly) {
  MotionFilter filter = after(5, {1e-3, 3e-3});
  filter.predict(6 * kPeriod_s, {});
  const ColorTime time = filter.color_time(0);
  DOUBLES_EQUAL(0, norm(time.motion.t), 1e-12);
  for (int i = 0; i < 6; ++i) {
    DOUBLES_EQUAL(1, time.tie.share[i], 1e-9);
    DOUBLES_EQUAL(0, time.tie.sigma[i], 1e-6);
  }
}

TEST(MotionFilter, TheTieIsThatOfTheMotionBetweenTheImages) {
  // Against samples of the state before the step, and of its acceleration.
  const Covariance usual{1e-3, 3e-3};
  const MotionFilter before = after(8, usual);
  MotionFilter filter = before;
  const MotionNoise noise;
  filter.predict(9 * kPeriod_s, noise);
  const double lag_s = -0.021, dt = kPeriod_s, s = dt + lag_s;
  const ColorTime time = filter.color_time(lag_s);
  DOUBLES_EQUAL(0, error_m(truth(9 * kPeriod_s + lag_s), time.motion * filter.pose()), 5e-4);
  // The variances of the state follow from what it predicts over other steps.
  const auto variance = [&](double step_s, double acceleration) {
    MotionFilter other = before;
    other.predict(8 * kPeriod_s + step_s, {acceleration, acceleration});
    return 1 / (kFloorFromCamera * Vec3{other.prior().information[0], 0, 0}).x * kFloorFromCamera(0, 0);
  };
  const double pp = variance(1e-9, 0), one = variance(dt, 0), two = variance(2 * dt, 0);
  const double rr = (two - 2 * one + pp) / (2 * dt * dt), pr = (one - pp - dt * dt * rr) / (2 * dt);
  const double q = noise.acceleration_mps2 * noise.acceleration_mps2;
  const double now = pp + 2 * dt * pr + dt * dt * rr + 0.25 * dt * dt * dt * dt * q;
  const double both = pp + (dt + s) * pr + dt * s * rr + 0.25 * dt * dt * s * s * q;
  const double then = pp + 2 * s * pr + s * s * rr + 0.25 * s * s * s * s * q;
  DOUBLES_EQUAL(both / now, time.tie.share[0], 1e-3);
  DOUBLES_EQUAL(std::sqrt(then - both * both / now), time.tie.sigma[0], 1e-5);
}

// Only colour sees the turn, and its image is 21 ms older than the depth image: when the turn begins and
// ends, the heading must follow without swinging.
TEST(MotionFilter, AHeadingSeenEarlierIsFollowedWithoutSwinging) {
  const double lag_s = -0.021, sigma_rad = 0.004;
  const auto heading = [](double t_s) { return t_s < 1 ? 0.0 : t_s < 2 ? 1.0 * (t_s - 1) : 1.0; };
  MotionFilter filter;
  const Pose at{Mat3{}, {0, 0, 2}};
  filter.start(at, Mat3{}, 0);
  double worst_rad = 0, late_rad = 0;
  for (int k = 1; k <= 120; ++k) {
    const double t_s = k * kPeriod_s;
    filter.predict(t_s, {});
    const ColorTime time = filter.color_time(lag_s);
    // The alignment of one axis: a heading seen then, the prior of the heading now.
    const double predicted = rotation_to_vector(filter.pose().R).z;
    const double predicted_then = predicted + rotation_to_vector(time.motion.R).z;
    NormalEquations seen, all;
    const double J[6] = {0, 0, 0, 0, 0, 1};
    seen.add(J, predicted_then - heading(t_s + lag_s), 1 / (sigma_rad * sigma_rad));
    for (int i = 0; i < 8; ++i) all.H[9 * i] = i < 6 ? filter.prior().information[7 * i] : 1;
    const double prior = all.H[9 * 5];
    const TieRest guess = add_tied(seen, time.tie, all);
    const double x = -all.g[5] / all.H[9 * 5];
    TieRest rest = guess;  // at the solution
    rest.mean[5] += guess.slope[5] * x;
    Covariance covariance{1e-3, 1e-3};
    covariance.m[35] = 1 / all.H[9 * 5];
    CHECK(all.H[9 * 5] >= prior);
    filter.correct({rotation_z(predicted + x), at.t}, covariance.m, rest, lag_s);
    const double error = std::fabs(predicted + x - heading(t_s));
    worst_rad = std::fmax(worst_rad, error);
    const double since = t_s < 1 ? t_s : t_s < 2 ? t_s - 1 : t_s - 2;
    if (since > 0.35) late_rad = std::fmax(late_rad, error);
  }
  CHECK(worst_rad < 0.07);
  CHECK(late_rad < 0.004);
  DOUBLES_EQUAL(0, filter.angular_velocity_rps().z, 0.02);
}

TEST(MotionFilter, TimeThatStandsStillChangesNothing) {
  MotionFilter filter = after(5);
  const Pose before = filter.pose();
  filter.predict(filter.t_s(), {});
  filter.predict(filter.t_s() - 1, {});
  DOUBLES_EQUAL(0, error_m(before, filter.pose()), 0);
}
