// The closed loop against an analytic robot: wheels that are not as large as believed, a tracker that sees
// the robot's pose with noise, in a frame of its own, and late.
#include <CppUTest/TestHarness.h>

#include <cmath>

#include "algo/control/base_tracker.hpp"
#include "algo/control/follower.hpp"
#include "algo/control/pose_follower.hpp"
#include "algo/core/scalar_math.hpp"
#include "tests/algo/control/obedient_robot.hpp"

using namespace st;
using namespace st::test;

namespace {

// Two circles of 0.6 m at 0.4 m/s, once under way: how far the robot is from them, and how far outside of
// them it is held to be.
struct Held {
  double rms_m = 0, mean_m = 0;
};
Held hold_circle(double slip, std::uint64_t seed) {
  Path path;
  path.limits.speed_mps = 0.4;
  path.add_arc(0.6, 4 * kPi);
  path.plan();
  sim::Random chance(seed);
  Robot robot;
  robot.pose = {};
  Obedience o = start(robot, chance, 0, kNobodyElse);
  o.base.T_object_base = kObjectBase;
  BaseTracker tracker;
  tracker.start(o, seen(1, robot.pose, chance).pose);
  const Pose2 T_floor_path = robot.pose, centre = compose(T_floor_path, {0, 0.6, 0});
  PoseFollower follower(path, kBase_m);
  WheelSpeeds told;
  double slips[2] = {0, 0}, sum = 0, squares = 0;
  int n = 0;
  for (int i = 0; !follower.done(); ++i) {
    const SeenObject object = seen(1, robot.pose, chance);
    const double passed_s = i == 0 ? 0 : kFrame_s;
    tracker.update(odometry(told, passed_s), 0, 0, &object);
    const Pose2 soon = tracker.after(odometry(told, 0.5 * kFrame_s));  // in the middle of the coming frame
    told = follower.step(compose(inverse(T_floor_path), soon), passed_s, tracker.extra_turn_rpm());
    const double keep = std::exp(-kFrame_s / 0.2);  // for how long a wheel slips alike
    for (double& s : slips) s = keep * s + slip * std::sqrt(1 - keep * keep) * chance.normal();
    robot.roll({told.left_mps * (1 - slips[0]), told.right_mps * (1 - slips[1])}, kFrame_s);
    if (i < 60) continue;
    const auto outside_m = [&](const Pose2& at) {
      return std::hypot(at.x - centre.x, at.y - centre.y) - 0.6;
    };
    squares += outside_m(robot.pose) * outside_m(robot.pose);
    sum += outside_m(tracker.base());
    ++n;
  }
  return {std::sqrt(squares / n), sum / n};
}

}  // namespace

TEST_GROUP(ClosedLoop) {
  sim::Random random{7};
  Robot robot;
};

TEST(ClosedLoop, TheStartMotionStaysWithinItsBoundsAndEndsWhereItBegan) {
  const Path path = start_motion();
  for (double t = 0; t < path.duration_s(); t += 0.01) {
    const PathSample p = sample(path, t);
    CHECK(std::fabs(p.x_m) <= 0.05 && std::fabs(p.y_m) < 1e-9);
    CHECK(std::fabs(p.yaw_rad) <= 10 * kPi / 180);
  }
  DOUBLES_EQUAL(0, sample(path, path.duration_s()).x_m, 1e-9);
  DOUBLES_EQUAL(0, sample(path, path.duration_s()).yaw_rad, 1e-9);
}

TEST(ClosedLoop, WhatObeyedTellsItsBaseAndTheCamerasLag) {
  for (const std::size_t lag : {std::size_t{0}, std::size_t{3}}) {
    const Obedience o = start(robot, random, lag, kNobodyElse);
    LONGS_EQUAL(1, o.id);
    DOUBLES_EQUAL(static_cast<double>(lag) * kFrame_s, o.lag_s, 0.012);
    DOUBLES_EQUAL(kObjectBase.x, o.base.T_object_base.x, 0.006);
    DOUBLES_EQUAL(kObjectBase.y, o.base.T_object_base.y, 0.006);
    DOUBLES_EQUAL(0, wrap_angle(kObjectBase.yaw - o.base.T_object_base.yaw), 0.03);
    DOUBLES_EQUAL(1.015, o.base.gain, 0.02);
  }
}

TEST(ClosedLoop, TheStartMotionTellsTheTurningCentreToTwoMillimetres) {
  double squares = 0;
  for (int i = 0; i < 50; ++i) {
    Robot another;
    const Pose2 base = start(another, random, 0, kNobodyElse).base.T_object_base;
    squares += std::pow(base.x - kObjectBase.x, 2) + std::pow(base.y - kObjectBase.y, 2);
  }
  CHECK(std::sqrt(squares / 50) < 0.0022);
}

// A walker, a robot that drives on its own, one that stands, and one that does the same thing a second later.
TEST(ClosedLoop, NobodyElseIsTakenForTheRobot) {
  const Path path = start_motion();
  const auto others = [&](double t, SeenObjects& objects) {
    objects.push_back(seen(2, {0.9 * t - 2, 0.3 * std::sin(6 * t), 0.3 * std::sin(3 * t)}, random));
    objects.push_back(seen(3, advanced({1, 1, 0}, 0.2 * t, 0.4 * t), random));
    const PathSample later = sample(path, t - 1);
    objects.push_back(seen(4, compose({0, 2, 1}, {later.x_m, later.y_m, later.yaw_rad}), random));
  };
  for (int i = 0; i < 20; ++i) LONGS_EQUAL(1, start(robot, random, 1, others).id);
}

TEST(ClosedLoop, NothingIsPickedWhereNothingObeysOrTwoDo) {
  Robot still;
  const Path path = start_motion();
  auto witness = std::make_unique<StartWitness>();
  for (int i = 0; i < 150; ++i) {  // the wheels turn, and nothing moves
    SeenObjects objects;
    objects.push_back(seen(1, still.pose, random));
    const PathSample a = sample(path, i * kFrame_s), b = sample(path, (i + 1) * kFrame_s);
    witness->add({true, b.x_m - a.x_m, b.yaw_rad - a.yaw_rad, kFrame_s}, objects);
  }
  LONGS_EQUAL(0, witness->judge().id);
  // A twin that is driven by the same commands: nobody can tell them apart.
  const auto twin = [&](double, SeenObjects& objects) {
    SeenObject object = objects[0];
    object.id = 2;
    object.pose = compose({1, 1, 1}, object.pose);
    objects.push_back(object);
  };
  LONGS_EQUAL(0, start(robot, random, 1, twin).id);
}

TEST(ClosedLoop, ThePathIsHeldWithUnequalWheelsAndFiveTimesAsWellAsWithout) {
  for (const double speed_mps : {0.2, 0.4}) {
    Path path;
    path.limits.speed_mps = speed_mps;
    path.add_arc(0.5, 2 * kPi);
    path.add_line(0.5);
    path.add_turn(kPi / 2);
    path.add_line(0.5);
    path.plan();
    Robot closed, open;
    closed.pose = {};
    const Obedience o = start(closed, random, 1, kNobodyElse);
    BaseTracker tracker;
    tracker.start(o, seen(1, closed.pose, random).pose);
    const Pose2 T_floor_path = closed.pose;
    open.pose = closed.pose;
    PoseFollower follower(path, kBase_m);
    OpenLoopFollower blind(path, kBase_m);
    WheelSpeeds told, blind_told;
    double worst = 0, worst_open = 0;
    for (int i = 0; !follower.done() && i < 3000; ++i) {
      const SeenObject object = seen(1, closed.pose, random);
      // A second without sight on the way: the wheels carry it.
      const bool covered = i > 150 && i < 180;
      tracker.update(odometry(told, i == 0 ? 0 : kFrame_s), 0, 0, covered ? nullptr : &object);
      CHECK(tracker.seen() == !covered);
      told = follower.step(compose(inverse(T_floor_path), tracker.base()), i == 0 ? 0 : kFrame_s,
                           tracker.extra_turn_rpm());
      blind_told = blind.done() ? WheelSpeeds{} : blind.step(i == 0 ? 0 : kFrame_s, kFrame_s);
      closed.roll(told, kFrame_s);
      open.roll(blind_told, kFrame_s);
      const PathSample to = follower.target();
      const Pose2 target = compose(T_floor_path, {to.x_m, to.y_m, 0});
      worst = std::max(worst, std::hypot(closed.pose.x - target.x, closed.pose.y - target.y));
      worst_open = std::max(worst_open, std::hypot(open.pose.x - target.x, open.pose.y - target.y));
    }
    CHECK(follower.done());
    CHECK(worst < 0.03);
    CHECK(worst_open > 5 * worst);
  }
}

// What the larger wheel turns the robot is not left to the errors to mend.
TEST(ClosedLoop, ALargerWheelLeavesNoErrorBehind) {
  double mean_m = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) mean_m += hold_circle(0, seed).mean_m / 5;
  DOUBLES_EQUAL(0, mean_m, 0.0015);
}

// Slip turns the robot by a degree or two within a second: what is seen of its heading has to tell.
TEST(ClosedLoop, SlipHardlyShowsAtFullSpeed) {
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double rms_m = hold_circle(0.03, seed).rms_m;
    squares += rms_m * rms_m / 20;
  }
  CHECK(std::sqrt(squares) < 0.005);
}
