#include "hal/sim/diff_drive_body.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kSlice_s = 0.001;
constexpr double kSlipCorrelation_s = 0.2;

double approach(double now, double wanted, double most) { return std::clamp(wanted, now - most, now + most); }

}  // namespace

DiffDriveBody::DiffDriveBody(double wheel_base_m, double accel_mps2, DiffDriveErrors errors,
                             std::uint64_t seed)
    : wheel_base_m_(wheel_base_m), accel_mps2_(accel_mps2), errors_(errors), random_(seed, 0xd21e) {}

void DiffDriveBody::command(double left_mps, double right_mps) {
  wanted_[0] = left_mps;
  wanted_[1] = right_mps;
}

void DiffDriveBody::place(const Pose2& pose) {
  pose_ = pose;
  for (int i = 0; i < 2; ++i) wanted_[i] = wheel_[i] = slip_[i] = 0;
  v_ = w_ = 0;
}

void DiffDriveBody::step(double dt_s) {
  // A sliver below a nanosecond is rounding of the caller's clock, not time.
  while (dt_s > 1e-9) {
    const double part = std::min(dt_s, kSlice_s - carried_s_);
    slice(part);
    dt_s -= part;
    carried_s_ += part;
    if (carried_s_ < kSlice_s - 1e-9) continue;
    carried_s_ = 0;
    if (errors_.slip_noise > 0) {
      // Ornstein-Uhlenbeck, so that the standard deviation does not depend on the slice.
      const double keep = 1 - kSlice_s / kSlipCorrelation_s;
      const double fresh = errors_.slip_noise * std::sqrt(1 - keep * keep);
      for (double& s : slip_) s = keep * s + fresh * random_.normal();
    }
  }
}

void DiffDriveBody::slice(double dt_s) {
  const double scale[2] = {errors_.left_scale, errors_.right_scale};
  double floor_mps[2];
  for (int i = 0; i < 2; ++i) {
    const double before = wheel_[i];
    wheel_[i] = approach(before, wanted_[i], accel_mps2_ * dt_s);
    floor_mps[i] = 0.5 * (before + wheel_[i]) * scale[i] * (1 - slip_[i]);
  }
  v_ = 0.5 * (floor_mps[0] + floor_mps[1]);
  w_ = (floor_mps[1] - floor_mps[0]) / wheel_base_m_;
  // Chord at the middle heading: exact to third order in the slice's turn.
  const SinCos half = sin_cos(pose_.yaw + 0.5 * w_ * dt_s);
  pose_.x += v_ * dt_s * half.cos;
  pose_.y += v_ * dt_s * half.sin;
  pose_.yaw += w_ * dt_s;
}

}  // namespace st
