#include "algo/control/wheel_motion.hpp"

#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kLeastGain = 0.3;  // below it there is no direction to speak of

}  // namespace

// The chord of the arc, at its middle heading; sin(x)/x to the order that a frame's turn needs.
Pose2 advanced(const Pose2& base, double forward_m, double turn_rad) {
  const SinCos heading = sin_cos(base.yaw + 0.5 * turn_rad);
  const double chord_m = forward_m * (1 - turn_rad * turn_rad / 24);
  return {base.x + chord_m * heading.cos, base.y + chord_m * heading.sin, wrap_angle(base.yaw + turn_rad)};
}

void BodyMotion::add(const Pose2& p, const Pose2& q) {
  const double turn = wrap_angle(q.yaw - p.yaw), dx = q.x - p.x, dy = q.y - p.y;
  const SinCos heading = sin_cos(p.yaw + 0.5 * turn);
  x_m += heading.cos * dx + heading.sin * dy;
  y_m += heading.cos * dy - heading.sin * dx;
  turn_rad += turn;
}

void WheelRegression::add(double forward_m, double turn_rad, const BodyMotion& seen, double sigma_m) {
  const double w = 1 / (sigma_m * sigma_m), f = forward_m, s = turn_rad;
  ff_ += w * f * f, fs_ += w * f * s, ss_ += w * s * s;
  xf_ += w * f * seen.x_m, xs_ += w * s * seen.x_m;
  yf_ += w * f * seen.y_m, ys_ += w * s * seen.y_m;
  total_ += w * (seen.x_m * seen.x_m + seen.y_m * seen.y_m);
  ++rows_;
}

void WheelRegression::weaken(double share) {
  double* const sums[] = {&ff_, &fs_, &ss_, &xf_, &xs_, &yf_, &ys_, &total_};
  for (double* sum : sums) *sum *= share;
}

BaseFit WheelRegression::fit(const BaseGuess& guess) const {
  BaseFit fit;
  const double prior = 1 / (guess.sigma_m * guess.sigma_m), ss = ss_ + prior;
  const double det = ff_ * ss - fs_ * fs_;
  if (!(det > 0)) return fit;
  const double xs = xs_ + prior * guess.y_m, ys = ys_ - prior * guess.x_m;
  const double C = (ss * xf_ - fs_ * xs) / det, by = (ff_ * xs - fs_ * xf_) / det;
  const double S = (ss * yf_ - fs_ * ys) / det, bx = -(ff_ * ys - fs_ * yf_) / det;
  fit.gain = std::sqrt(C * C + S * S);
  fit.valid = fit.gain > kLeastGain;
  fit.T_object_base = {bx, by, arc_tan2(S, C)};
  return fit;
}

double WheelRegression::residual(const BaseFit& fit) const {
  const SinCos d = sin_cos(fit.T_object_base.yaw);
  const double C = fit.gain * d.cos, S = fit.gain * d.sin, by = fit.T_object_base.y,
               bx = -fit.T_object_base.x;
  const double squares = (C * C + S * S) * ff_ + 2 * (C * by + S * bx) * fs_ + (by * by + bx * bx) * ss_;
  const double rest = total_ + squares - 2 * (C * xf_ + by * xs_ + S * yf_ + bx * ys_);
  return rest > 0 ? rest : 0;
}

}  // namespace st
