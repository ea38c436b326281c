#include "algo/control/path.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <memory>

#include "algo/core/scalar_math.hpp"
#include "hal/sim/random.hpp"

using namespace st;

TEST_GROUP(Path){};

TEST(Path, ALineIsATrapezoid) {
  Path path;  // 0.2 m/s, 0.4 m/s2
  CHECK(path.add_line(1.0));
  path.plan();
  DOUBLES_EQUAL(1.0 / 0.2 + 0.2 / 0.4, path.duration_s(), 1e-12);
  DOUBLES_EQUAL(0.5 * 0.4 * 0.25 * 0.25, sample(path, 0.25).x_m, 1e-12);
  DOUBLES_EQUAL(0.1, sample(path, 0.25).v_mps, 1e-12);
  DOUBLES_EQUAL(0.5, sample(path, path.duration_s() / 2).x_m, 1e-12);
  DOUBLES_EQUAL(1.0, sample(path, 99).x_m, 1e-12);
  DOUBLES_EQUAL(0.0, sample(path, 99).v_mps, 0);
  DOUBLES_EQUAL(0.0, sample(path, -1).x_m, 0);
  DOUBLES_EQUAL(1.0, path.length_m(), 1e-12);
}

TEST(Path, AShortLineNeverReachesItsSpeed) {
  Path path;
  path.add_line(0.05);
  path.plan();
  DOUBLES_EQUAL(2 * std::sqrt(0.05 / 0.4), path.duration_s(), 1e-12);
  DOUBLES_EQUAL(std::sqrt(0.05 * 0.4), sample(path, path.duration_s() / 2).v_mps, 1e-9);
}

TEST(Path, ACircleKeepsItsDistanceFromTheCentre) {
  Path path;
  path.add_arc(0.5, -2 * 2 * kPi);  // twice, to the right
  path.plan();
  for (double t = 0; t < path.duration_s(); t += 0.05) {
    const PathSample p = sample(path, t);
    DOUBLES_EQUAL(0.5, std::hypot(p.x_m, p.y_m + 0.5), 1e-12);
    DOUBLES_EQUAL(p.v_mps, -0.5 * p.w_rps, 1e-12);
  }
  DOUBLES_EQUAL(-4 * kPi, sample(path, path.duration_s()).yaw_rad, 1e-12);
}

TEST(Path, ASquareEndsWhereItBegan) {
  Path path;
  CHECK(path.add_square(1.0, 1));
  path.plan();
  const PathSample corner = path.segment(4).start, end = sample(path, path.duration_s());
  DOUBLES_EQUAL(1.0, corner.x_m, 1e-12);
  DOUBLES_EQUAL(1.0, corner.y_m, 1e-12);
  DOUBLES_EQUAL(0.0, std::hypot(end.x_m, end.y_m), 1e-12);
  DOUBLES_EQUAL(2 * kPi, end.yaw_rad, 1e-12);
}

TEST(Path, StopsOnlyWhereItMust) {
  Path path;
  path.add_arc(0.5, kPi);
  path.add_arc(0.5, kPi);  // the same curve: no reason to slow down
  path.add_line(1.0);      // 0.4 rad/s would end at once
  path.add_turn(kPi / 2);  // stands
  path.add_line(-1.0);
  path.add_line(-1.0);
  path.add_wait(2.0);
  path.plan();
  DOUBLES_EQUAL(0.2, path.segment(1).entry_speed, 1e-12);
  DOUBLES_EQUAL(0.1, path.segment(2).entry_speed, 1e-12);
  DOUBLES_EQUAL(0.0, path.segment(3).entry_speed, 0);
  DOUBLES_EQUAL(0.0, path.segment(4).entry_speed, 0);
  DOUBLES_EQUAL(-0.2, sample(path, path.segment(4).start.t_s + 2.0).v_mps, 1e-12);
  DOUBLES_EQUAL(2.0, path.segment(6).duration_s, 0);
  DOUBLES_EQUAL(0.0, sample(path, path.segment(6).start.t_s + 1).v_mps, 0);
}

// Whatever is put together: the pose is the integral of the speeds, and no wheel jumps.
TEST(Path, SpeedsAreTheDerivativeOfThePoseAndStayWithinTheLimits) {
  sim::Random random(3);
  for (int trial = 0; trial < 40; ++trial) {
    Path path;
    for (int i = 0; i < 12; ++i) {
      const int kind = random.below(5);
      if (kind == 0) path.add_line(random.uniform(-0.6, 0.6));
      if (kind == 1) path.add_line(random.uniform(0.001, 0.02));
      if (kind == 2) path.add_arc(random.uniform(0.1, 1), random.uniform(-3, 3));
      if (kind == 3) path.add_turn(random.uniform(-3, 3));
      if (kind == 4) path.add_wait(random.uniform(0, 0.5));
    }
    path.plan();
    const double dt = 1e-3;
    PathSample before = sample(path, 0);
    for (double t = dt; t <= path.duration_s(); t += dt) {
      const PathSample p = sample(path, t);
      const double v = 0.5 * (p.v_mps + before.v_mps), yaw = 0.5 * (p.yaw_rad + before.yaw_rad);
      CHECK(std::fabs(p.v_mps) <= 0.2 + 1e-9 && std::fabs(p.w_rps) <= 1.0 + 1e-9);
      CHECK(std::fabs(p.v_mps - before.v_mps) <= 0.4 * dt + 1e-9);
      CHECK(std::fabs(p.w_rps - before.w_rps) <= 0.2 + (2.0 + 0.4 / 0.1) * dt + 1e-9);
      DOUBLES_EQUAL(v * dt * std::cos(yaw), p.x_m - before.x_m, 2e-6);
      DOUBLES_EQUAL(v * dt * std::sin(yaw), p.y_m - before.y_m, 2e-6);
      DOUBLES_EQUAL(0.5 * (p.w_rps + before.w_rps) * dt, p.yaw_rad - before.yaw_rad, 2.1e-4);
      before = p;
    }
  }
}

TEST(Path, TellsTheFastestWheel) {
  Path path;
  path.limits.speed_mps = 0.3;
  path.limits.turn_rps = 5;
  path.add_arc(0.26, 1.0);
  DOUBLES_EQUAL(0.3 * 1.5, path.fastest_wheel_mps(0.26), 1e-12);
  path.add_turn(1.0);
  DOUBLES_EQUAL(5 * 0.13, path.fastest_wheel_mps(0.26), 1e-12);
  const WheelSpeeds left_curve = wheel_speeds(0.2, 0.4, 0.25);
  DOUBLES_EQUAL(0.15, left_curve.left_mps, 1e-12);
  DOUBLES_EQUAL(0.25, left_curve.right_mps, 1e-12);
}

TEST(Path, RefusesMoreThanItHolds) {
  const auto path = std::make_unique<Path>();
  for (std::size_t i = 0; i < Path::kMaxSegments; ++i) CHECK(path->add_line(0.1));
  CHECK_FALSE(path->add_line(0.1));
  CHECK_FALSE(path->add_square(1, 1));
}
