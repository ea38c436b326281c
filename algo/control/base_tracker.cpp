#include "algo/control/base_tracker.hpp"

#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kStartWeight = 0.25;  // its samples were neighbours, their errors alike
constexpr double kWindow_m = 0.05, kWindow_rad = 0.25, kWindowSigma_m = 0.003;
constexpr double kPositionShare = 0.4, kYawShare = 0.3;  // of the way to what is measured, in one frame
constexpr double kFarthest_m = 0.08, kFarthest_rad = 0.35;
constexpr int kMostRefused = 15;  // half a second of poses that agree among themselves: they are right

bool is_far(const Pose2& a, const Pose2& b) {
  const double dx = a.x - b.x, dy = a.y - b.y;
  return dx * dx + dy * dy > kFarthest_m * kFarthest_m ||
         std::fabs(wrap_angle(a.yaw - b.yaw)) > kFarthest_rad;
}

}  // namespace

Pose2 advanced(const Pose2& base, double forward_m, double turn_rad) {
  const SinCos heading = sin_cos(base.yaw + 0.5 * turn_rad);
  const double chord_m = forward_m * (1 - turn_rad * turn_rad / 24);
  return {base.x + chord_m * heading.cos, base.y + chord_m * heading.sin, wrap_angle(base.yaw + turn_rad)};
}

void BaseTracker::start(const Obedience& picked, const Pose2& object) {
  *this = BaseTracker{};
  regression_ = picked.motion;
  regression_.weaken(kStartWeight);
  fit_ = picked.base;
  guess_ = {fit_.T_object_base.x, fit_.T_object_base.y, 0.05};
  base_ = compose(object, fit_.T_object_base);
  seen_ = true;
}

// The travel by the wheels, the turn by the camera: a wheel that is too large turns the robot, but hardly
// changes its way.
void BaseTracker::learn(const WheelOdometry& wheels, const Pose2& object) {
  if (!has_object_ || !wheels.valid) {
    window_ = {};
    window_forward_m_ = 0;
    return;
  }
  window_.add(object_, object);
  window_forward_m_ += wheels.forward_m;
  if (std::fabs(window_forward_m_) < kWindow_m && std::fabs(window_.turn_rad) < kWindow_rad) return;
  regression_.add(window_forward_m_, window_.turn_rad, window_, kWindowSigma_m);
  window_ = {};
  window_forward_m_ = 0;
  const BaseFit fit = regression_.fit(guess_);
  if (fit.valid) fit_ = fit;
}

void BaseTracker::update(const WheelOdometry& wheels, double told_v_mps, double told_w_rps,
                         const SeenObject* object) {
  base_ = wheels.valid ? advanced(base_, wheels.forward_m, wheels.turn_rad)
                       : advanced(base_, told_v_mps * wheels.dt_s, told_w_rps * wheels.dt_s);
  const bool good = object != nullptr && object->good;
  seen_ = false;
  if (good) {
    learn(wheels, object->pose);
    object_ = object->pose;
    const Pose2 measured = compose(object->pose, fit_.T_object_base);
    refused_ = is_far(measured, base_) ? refused_ + 1 : 0;
    if (refused_ > kMostRefused) {
      base_ = measured;
      refused_ = 0;
    }
    seen_ = refused_ == 0;
    if (seen_)
      base_ = {base_.x + kPositionShare * (measured.x - base_.x),
               base_.y + kPositionShare * (measured.y - base_.y),
               wrap_angle(base_.yaw + kYawShare * wrap_angle(measured.yaw - base_.yaw))};
  }
  has_object_ = good;
}

}  // namespace st
