// Where wheel travel says that the base is: the frame of its start, yaw unwrapped.
#pragma once

#include "algo/core/pose.hpp"
#include "algo/core/records.hpp"
#include "algo/core/scalar_math.hpp"

namespace st {

class DeadReckoning {
 public:
  explicit DeadReckoning(double wheel_base_m) : wheel_base_m_(wheel_base_m) {}

  void add(const OdometrySample& sample) {
    const double way = 0.5 * (sample.left_m + sample.right_m),
                 turn = (sample.right_m - sample.left_m) / wheel_base_m_;
    // The chord of the arc, at its middle heading; sin(x)/x to the order that a slot's turn needs.
    const double chord = way * (1 - turn * turn / 24);
    const SinCos heading = sin_cos(pose_.yaw + 0.5 * turn);
    pose_ = {pose_.x + chord * heading.cos, pose_.y + chord * heading.sin, pose_.yaw + turn};
  }
  const Pose2& pose() const { return pose_; }

 private:
  double wheel_base_m_;
  Pose2 pose_;
};

}  // namespace st
