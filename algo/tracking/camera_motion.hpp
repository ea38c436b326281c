// How a hand-held camera moves on: constant velocity over a frame, which is all that a hand allows to say.
#pragma once

#include "algo/core/pose.hpp"

namespace st {

class CameraMotion {
 public:
  // Where the camera will be at t_s. Without two recent poses, or after a gap: where it was.
  Pose predict(double t_s) const {
    if (!moving_ || t_s <= t_s_ || t_s - t_s_ > kLongest_s) return T_;
    const double dt = t_s - t_s_;
    return {T_.R * rotation_from_vector(velocity_.w * dt), T_.t + velocity_.v * dt};
  }

  // A pose that is believed.
  void take(double t_s, const Pose& T_world_camera) {
    const double dt = t_s - t_s_;
    moving_ = known_ && dt > 0 && dt < kLongest_s;
    if (moving_)
      velocity_ = {(T_world_camera.t - T_.t) * (1.0 / dt),
                   rotation_to_vector(T_.R.transposed() * T_world_camera.R) * (1.0 / dt)};
    known_ = true;
    t_s_ = t_s;
    T_ = T_world_camera;
  }
  // The camera is found somewhere: nothing is known of its speed.
  void restart(double t_s, const Pose& T_world_camera) {
    known_ = false;
    take(t_s, T_world_camera);
  }
  // T_now_then: how the camera moves on within `dt_s` (either sign) at its present speed.
  Pose moved_within(double dt_s) const {
    if (!moving_) return {};
    return {rotation_from_vector(velocity_.w * dt_s), T_.R.transposed() * (velocity_.v * dt_s)};
  }
  // The pose just taken is doubtful: the speed that it implies fades, so that it does not carry the camera
  // off.
  void slow() { velocity_ = {velocity_.v * kFading, velocity_.w * kFading}; }

  const Pose& last() const { return T_; }

 private:
  static constexpr double kLongest_s = 0.2, kFading = 0.8;

  bool known_ = false, moving_ = false;
  double t_s_ = 0;
  Pose T_;
  Twist velocity_;  // translation in the world frame, rotation in the camera's; per second
};

}  // namespace st
