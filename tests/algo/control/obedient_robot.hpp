// An analytic robot: wheels that are not as large as believed, a tracker that sees its pose with noise, in a
// frame of its own, and late.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>

#include "algo/control/follower.hpp"
#include "algo/control/start_motion.hpp"
#include "hal/sim/random.hpp"

namespace st::test {

inline constexpr double kBase_m = 0.235, kFrame_s = 1.0 / 30.0;
inline const Pose2 kObjectBase{0.03, -0.02, 2.1};  // the robot's base in the frame of the tracked object

struct Robot {
  double right_scale = 1.03;
  Pose2 pose{0.4, -0.7, 0.9};

  void roll(const WheelSpeeds& told, double dt_s) {
    const double right = told.right_mps * right_scale;
    pose = advanced(pose, 0.5 * (told.left_mps + right) * dt_s, (right - told.left_mps) / kBase_m * dt_s);
  }
};

inline WheelOdometry odometry(const WheelSpeeds& told, double dt_s) {
  return {true, 0.5 * (told.left_mps + told.right_mps) * dt_s,
          (told.right_mps - told.left_mps) / kBase_m * dt_s, dt_s};
}

inline SeenObject seen(int id, const Pose2& base, sim::Random& random) {
  SeenObject object;
  object.id = id;
  object.good = object.has_heading = true;
  object.pose = compose(base, inverse(kObjectBase));
  object.pose = {object.pose.x + 0.001 * random.normal(), object.pose.y + 0.001 * random.normal(),
                 object.pose.yaw + 0.006 * random.normal()};
  return object;
}

// Drives the start motion; `others(t)` adds what else is seen. The camera is `lag_frames` late.
template <typename Others>
Obedience start(Robot& robot, sim::Random& random, std::size_t lag_frames, Others&& others) {
  const Path path = start_motion();
  auto witness = std::make_unique<StartWitness>();
  OpenLoopFollower follower(path, kBase_m);
  std::deque<Pose2> late(lag_frames + 1, robot.pose);
  WheelSpeeds speeds;
  double t = 0;
  for (int i = 0; i < 200; ++i, t += kFrame_s) {
    SeenObjects objects;
    objects.push_back(seen(1, late.front(), random));
    others(t, objects);
    witness->add(odometry(speeds, kFrame_s), objects);
    speeds = follower.done() ? WheelSpeeds{} : follower.step(i == 0 ? 0 : kFrame_s, kFrame_s);
    robot.roll(speeds, kFrame_s);
    late.push_back(robot.pose);
    late.pop_front();
  }
  return witness->judge();
}

inline const auto kNobodyElse = [](double, SeenObjects&) {};

}  // namespace st::test
