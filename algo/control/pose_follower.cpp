#include "algo/control/pose_follower.hpp"

#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kAcross_1pm2 = 40.0;  // an error across the path is gone after some 0.4 m
constexpr double kDamping = 0.9;
constexpr double kLeastRate_1ps = 1.2;                       // while the reference hardly moves
constexpr double kMostBack_mps = 0.12, kMostBack_rps = 1.0;  // of what is fed back
constexpr double kFastest_mps = 0.5;                         // of a Create's wheel
constexpr double kLongestArrival_s = 1.0, kThere_m = 0.004, kThere_rad = 0.012;

double limited(double v, double most) { return v > most ? most : v < -most ? -most : v; }

}  // namespace

bool PoseFollower::done() const {
  const double late_s = time_s_ - path_->duration_s();
  return late_s >= 0 && (arrived_ || late_s > kLongestArrival_s);
}

WheelSpeeds PoseFollower::step(const Pose2& base, double passed_s, double extra_turn_rpm) {
  time_s_ += passed_s;
  const PathSample to = target();
  const SinCos h = sin_cos(base.yaw);
  const double dx = to.x_m - base.x, dy = to.y_m - base.y, turn = wrap_angle(to.yaw_rad - base.yaw);
  const double along = h.cos * dx + h.sin * dy, across = h.cos * dy - h.sin * dx;
  arrived_ = time_s_ >= path_->duration_s() && std::fabs(along) < kThere_m && std::fabs(turn) < kThere_rad;
  if (done()) return {};
  const double rate = 2 * kDamping * std::sqrt(to.w_rps * to.w_rps + kAcross_1pm2 * to.v_mps * to.v_mps);
  const double gain = rate > kLeastRate_1ps ? rate : kLeastRate_1ps;
  const double v = to.v_mps * sin_cos(turn).cos + limited(gain * along, kMostBack_mps);
  const double w = to.w_rps + limited(kAcross_1pm2 * to.v_mps * across + gain * turn, kMostBack_rps);
  WheelSpeeds speeds = wheel_speeds(v, w - extra_turn_rpm * v, wheel_base_m_);
  // Both wheels give way alike, so that the curve stays the same.
  const double left = std::fabs(speeds.left_mps), right = std::fabs(speeds.right_mps);
  const double fastest = left > right ? left : right;
  if (fastest > kFastest_mps) {
    speeds.left_mps *= kFastest_mps / fastest;
    speeds.right_mps *= kFastest_mps / fastest;
  }
  return speeds;
}

}  // namespace st
