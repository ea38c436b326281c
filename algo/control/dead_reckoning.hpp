// Where wheel travel says that the base is: the frame of its start, yaw unwrapped.
#pragma once

#include "algo/control/wheel_motion.hpp"
#include "algo/core/records.hpp"

namespace st {

class DeadReckoning {
 public:
  explicit DeadReckoning(double wheel_base_m) : wheel_base_m_(wheel_base_m) {}

  void add(const OdometrySample& sample) {
    const double way = 0.5 * (sample.left_m + sample.right_m),
                 turn = (sample.right_m - sample.left_m) / wheel_base_m_;
    const double yaw = pose_.yaw + turn;
    pose_ = advanced(pose_, way, turn);
    pose_.yaw = yaw;
  }
  const Pose2& pose() const { return pose_; }

 private:
  double wheel_base_m_;
  Pose2 pose_;
};

}  // namespace st
