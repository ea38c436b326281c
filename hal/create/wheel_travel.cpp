#include "hal/create/wheel_travel.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kFastest_mps = 0.6;     // 500 mm/s and what the clocks may differ
constexpr double kLateFrame_s = 0.1;     // USB hands frames over in bursts: stamps may be this late
constexpr double kLongestHold_s = 0.25;  // a requested speed is not carried on over a longer silence

// What is left of `error` after rounding by at most `step` is taken off.
double beyond_rounding(double error, double step) {
  return error > step ? error - step : error < -step ? error + step : 0.0;
}

double metres_per_count(const RobotGeometry& g) { return kPi * g.wheel_diameter_m / g.counts_per_turn; }

int count_difference(int now, std::uint16_t before) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(now - before));
}

}  // namespace

double wheel_scale(const RobotGeometry& believed, const RobotGeometry& actual) {
  return metres_per_count(actual) / metres_per_count(believed);
}

WheelShares wheel_shares(const RobotGeometry& geometry) {
  const double left = 2 / (1 + geometry.right_to_left);
  return {left, left * geometry.right_to_left};
}

bool WheelTravel::update(double t_s, const SensorState& state, bool after_loss, OdometrySample& sample) {
  if (state.has(oi::kEncoderLeft) && state.has(oi::kEncoderRight)) return from_encoders(t_s, state, sample);
  if (state.has(oi::kRequestedLeft) && state.has(oi::kRequestedRight))
    return from_requests(t_s, state, after_loss, sample);
  return false;
}

bool WheelTravel::from_encoders(double t_s, const SensorState& state, OdometrySample& sample) {
  const int left = state.value(oi::kEncoderLeft), right = state.value(oi::kEncoderRight);
  const double m_per_count = metres_per_count(geometry_);
  const double dt_s = std::max(0.0, t_s - last_t_s_) + kLateFrame_s;
  const auto possible = [&](int a, int b) {
    return std::max(std::abs(a), std::abs(b)) * m_per_count <= kFastest_mps * dt_s;
  };
  int d_left = count_difference(left, left_), d_right = count_difference(right, right_);
  const bool report = started_;
  if (started_ && !possible(d_left, d_right)) {
    const int s_left = count_difference(left, suspect_left_),
              s_right = count_difference(right, suspect_right_);
    const bool restarted = suspect_ && possible(s_left, s_right);
    suspect_ = !restarted;
    suspect_left_ = static_cast<std::uint16_t>(left);
    suspect_right_ = static_cast<std::uint16_t>(right);
    ++refused_;
    if (!restarted) return false;
    d_left = s_left;
    d_right = s_right;
  } else {
    suspect_ = false;
  }
  started_ = true;
  left_ = static_cast<std::uint16_t>(left);
  right_ = static_cast<std::uint16_t>(right);
  last_t_s_ = t_s;
  const WheelShares share = wheel_shares(geometry_);
  sample = {t_s, share.left * d_left * m_per_count, share.right * d_right * m_per_count};
  return report;
}

bool WheelTravel::from_requests(double t_s, const SensorState& state, bool after_loss,
                                OdometrySample& sample) {
  if (after_loss || t_s - last_t_s_ > kLateFrame_s) comparable_ = false;
  const double dt_s = started_ ? std::clamp(t_s - last_t_s_, 0.0, kLongestHold_s) : 0.0;
  double left_m = state.value(oi::kRequestedLeft) * 1e-3 * dt_s;
  double right_m = state.value(oi::kRequestedRight) * 1e-3 * dt_s;
  predicted_m_ += 0.5 * (left_m + right_m);
  predicted_rad_ += (right_m - left_m) / believed_.wheel_base_m;
  if (state.has(oi::kDistance) && state.has(oi::kAngle)) {
    if (comparable_) {
      const double along_m = beyond_rounding(state.value(oi::kDistance) * 1e-3 - predicted_m_, 1e-3);
      const double turn_rad =
          beyond_rounding(state.value(oi::kAngle) * kPi / 180 - predicted_rad_, kPi / 180);
      left_m += along_m - 0.5 * turn_rad * believed_.wheel_base_m;
      right_m += along_m + 0.5 * turn_rad * believed_.wheel_base_m;
    }
    comparable_ = true;
    predicted_m_ = predicted_rad_ = 0;
  }
  const bool report = started_;
  started_ = true;
  last_t_s_ = t_s;
  const double scale = wheel_scale(believed_, geometry_);
  const WheelShares share = wheel_shares(geometry_);
  sample = {t_s, share.left * scale * left_m, share.right * scale * right_m};
  return report;
}

}  // namespace st
