#include "algo/control/follower.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

#include "algo/control/dead_reckoning.hpp"
#include "algo/core/scalar_math.hpp"
#include "hal/sim/random.hpp"

using namespace st;

namespace {

// Drives ideal wheels with ticks that are late by up to `jitter_s`, and tells where they end.
Pose2 drive(const Path& path, double base_m, double jitter_s, std::uint64_t seed) {
  sim::Random random(seed);
  OpenLoopFollower follower(path, base_m);
  DeadReckoning robot(base_m);
  double passed_s = 0;
  for (int i = 0; i < 100000 && !follower.done(); ++i) {
    const WheelSpeeds speeds = follower.step(passed_s, 0.02);
    CHECK(std::fabs(speeds.left_mps) <= 0.5 && std::fabs(speeds.right_mps) <= 0.5);
    passed_s = 0.02 + random.uniform() * jitter_s;
    robot.add({0, speeds.left_mps * passed_s, speeds.right_mps * passed_s});
  }
  CHECK(follower.done());
  return robot.pose();
}

}  // namespace

TEST_GROUP(Follower) {
  Path path;
  void setup() override {
    path.add_line(0.5);
    path.add_turn(-kPi / 2);
    path.add_arc(0.3, kPi);
    path.add_wait(0.3);
    path.add_line(-0.2);
    path.plan();
  }
};

TEST(Follower, CommandsAddUpToThePath) {
  const PathSample end = sample(path, path.duration_s());
  for (const double jitter_s : {0.0, 0.005, 0.03}) {
    const Pose2 at = drive(path, 0.235, jitter_s, 1);
    DOUBLES_EQUAL(end.x_m, at.x, 0.004);
    DOUBLES_EQUAL(end.y_m, at.y, 0.004);
    DOUBLES_EQUAL(end.yaw_rad, at.yaw, 0.005);
  }
}

TEST(Follower, RoundingToWholeMillimetresPerSecondDoesNotAddUp) {
  Path slow;
  slow.limits.speed_mps = 0.0333;
  slow.add_line(2.0);
  slow.plan();
  DOUBLES_EQUAL(2.0, drive(slow, 0.258, 0, 1).x, 0.0006);
}

TEST(Follower, SpeedsAreWholeMillimetresPerSecond) {
  OpenLoopFollower follower(path, 0.235);
  for (int i = 0; i < 100; ++i) {
    const WheelSpeeds s = follower.step(0.02, 0.02);
    DOUBLES_EQUAL(std::round(s.left_mps * 1000), s.left_mps * 1000, 1e-9);
    DOUBLES_EQUAL(std::round(s.right_mps * 1000), s.right_mps * 1000, 1e-9);
  }
}

// A tick that lasts a quarter of a second instead of a thirtieth: what it overshot is not made up at once.
TEST(Follower, IrregularTicksNeitherHurryTheWheelsNorThrowThem) {
  Path there_and_back;
  there_and_back.limits = {0.1, 0.3, 0.5, 1.0};
  for (const double way_m : {0.2, -0.2}) {
    there_and_back.add_line(way_m);
    there_and_back.add_wait(0.5);
  }
  there_and_back.plan();
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    sim::Random random(seed);
    OpenLoopFollower follower(there_and_back, 0.235);
    double at_m = 0, passed_s = 0;
    while (!follower.done()) {
      const WheelSpeeds speeds = follower.step(passed_s, 1 / 30.0);
      CHECK(std::fabs(speeds.left_mps) <= 0.1 && std::fabs(speeds.right_mps) <= 0.1);
      passed_s = random.uniform() < 0.3 ? 0.25 : 0.01 + 0.03 * random.uniform();
      at_m += passed_s * speeds.left_mps;
      CHECK(at_m > -0.012 && at_m < 0.212);  // braking 0.3 m/s^2 too late by a quarter of a second
    }
    DOUBLES_EQUAL(0, at_m, 0.002);
  }
}

TEST(Follower, DeadReckoningClosesACircle) {
  DeadReckoning robot(0.25);
  const double turn = 2 * kPi / 500;  // a slot's worth at full speed
  for (int i = 0; i < 500; ++i) robot.add({0, (0.5 - 0.125) * turn, (0.5 + 0.125) * turn});
  DOUBLES_EQUAL(0.0, robot.pose().x, 1e-6);
  DOUBLES_EQUAL(0.0, robot.pose().y, 1e-6);
  DOUBLES_EQUAL(2 * kPi, robot.pose().yaw, 1e-12);
}
