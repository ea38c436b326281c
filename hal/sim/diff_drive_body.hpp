// Where a differential-drive robot goes when its wheels are told to turn: acceleration limit, wheels that are
// not of the size the robot believes, and slip. Frame: where it started, x forward, y left, yaw
// counter-clockwise; unwrapped.
#pragma once

#include <cstdint>

#include "algo/core/pose.hpp"
#include "hal/sim/random.hpp"

namespace st {

struct DiffDriveErrors {
  double left_scale = 1,
         right_scale =
             1;           // true wheel size beside the nominal one: travel on the floor = scale * wheel speed
  double slip_noise = 0;  // standard deviation of each wheel's slip ratio (correlated over 0.2 s)
};

class DiffDriveBody {
 public:
  DiffDriveBody(double wheel_base_m, double accel_mps2, DiffDriveErrors errors, std::uint64_t seed);

  // Wheel speeds wanted from now on, in nominal wheel size; reached at the acceleration limit.
  void command(double left_mps, double right_mps);
  // Advances by dt_s >= 0. Works in slices of 1 ms of its own clock: how a span is cut into calls changes
  // nothing but rounding.
  void step(double dt_s);
  // Puts the body somewhere else, standing.
  void place(const Pose2& pose);

  Pose2 pose() const { return pose_; }
  // Wheel speeds as the wheels' own encoders see them: nominal wheel size, no slip.
  double left_mps() const { return wheel_[0]; }
  double right_mps() const { return wheel_[1]; }
  // True speeds of the body in m/s and rad/s: wheel size and slip included.
  double v() const { return v_; }
  double w() const { return w_; }

 private:
  void slice(double dt_s);

  double wheel_base_m_, accel_mps2_;
  DiffDriveErrors errors_;
  sim::Random random_;
  Pose2 pose_{};
  double wanted_[2]{}, wheel_[2]{}, slip_[2]{};
  double v_ = 0, w_ = 0;
  double carried_s_ = 0;  // since the last slip draw
};

}  // namespace st
