#include "algo/control/base_tracker.hpp"

#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kStartWeight = 0.25;  // its samples were neighbours, their errors alike
constexpr double kWindow_m = 0.05, kWindow_rad = 0.25, kWindowSigma_m = 0.003;
// Of a tracked pose, wider than its scatter, since errors of neighbouring frames go together.
constexpr double kPlaceSigma_m = 0.003, kHeadingSigma_rad = 0.02;
constexpr double kPlaceGate_m = 0.05, kHeadingGate_rad = 0.08;  // what may always be true
constexpr double kGateSigmas = 4;
// What the wheels get wrong: shares of the way and of the turn, and what comes of standing.
constexpr double kWaySlip = 0.03, kTurnSlip = 0.04, kTurnPerWay_rpm = 0.3;
constexpr double kRest_m = 0.0004, kRest_rad = 0.0006;
constexpr double kExtraTurn_rpm = 0.15, kExtraTurnDrift_rpm = 0.002;  // at the start; of a frame
constexpr int kMostRefused = 15;  // half a second of places that agree with each other and with the wheels

double squared(double v) { return v * v; }

}  // namespace

void BaseTracker::start(const Obedience& picked, const Pose2& object) {
  *this = BaseTracker{};
  regression_ = picked.motion;
  regression_.weaken(kStartWeight);
  fit_ = picked.base;
  guess_ = {fit_.T_object_base.x, fit_.T_object_base.y, 0.05};
  begin_at(compose(object, fit_.T_object_base));
  seen_ = true;
}

void BaseTracker::begin_at(const Pose2& base) {
  base_ = base;
  const double sigmas[kStates] = {kPlaceSigma_m, kPlaceSigma_m, kHeadingSigma_rad, kExtraTurn_rpm};
  for (int r = 0; r < kStates; ++r)
    for (int c = 0; c < kStates; ++c) P_[r][c] = r == c ? squared(sigmas[r]) : 0;
  extra_turn_rpm_ = 0;
  refused_ = 0;
}

void BaseTracker::predict(double forward_m, double turn_rad) {
  const double turn = turn_rad + extra_turn_rpm_ * forward_m;
  const SinCos h = sin_cos(base_.yaw + 0.5 * turn);
  base_ = advanced(base_, forward_m, turn);
  refused_base_ = advanced(refused_base_, forward_m, turn);
  const double f = forward_m;
  // P = F P F', where F is the identity and these.
  const double by_yaw[2] = {-f * h.sin, f * h.cos};
  double F[kStates][kStates] = {{1, 0, by_yaw[0], 0.5 * f * by_yaw[0]},
                                {0, 1, by_yaw[1], 0.5 * f * by_yaw[1]},
                                {0, 0, 1, f},
                                {0, 0, 0, 1}};
  double FP[kStates][kStates]{};
  for (int r = 0; r < kStates; ++r)
    for (int c = 0; c < kStates; ++c)
      for (int k = 0; k < kStates; ++k) FP[r][c] += F[r][k] * P_[k][c];
  for (int r = 0; r < kStates; ++r)
    for (int c = 0; c < kStates; ++c) {
      P_[r][c] = 0;
      for (int k = 0; k < kStates; ++k) P_[r][c] += FP[r][k] * F[c][k];
    }
  const double place = squared(kWaySlip * f) + squared(kRest_m);
  P_[0][0] += place;
  P_[1][1] += place;
  P_[2][2] += squared(kTurnSlip * turn_rad) + squared(kTurnPerWay_rpm * f) + squared(kRest_rad);
  P_[3][3] += f != 0 ? squared(kExtraTurnDrift_rpm) : 0;
}

BaseTracker::Innovation BaseTracker::innovation(double error, const double (&H)[kStates],
                                                double sigma) const {
  Innovation e;
  e.error = error;
  e.S = sigma * sigma;
  for (int r = 0; r < kStates; ++r) {
    e.H[r] = H[r];
    for (int c = 0; c < kStates; ++c) e.PH[r] += P_[r][c] * H[c];
    e.S += H[r] * e.PH[r];
  }
  return e;
}

void BaseTracker::correct(const Innovation& e) {
  const double step = e.error / e.S;
  base_ = {base_.x + e.PH[0] * step, base_.y + e.PH[1] * step, wrap_angle(base_.yaw + e.PH[2] * step)};
  extra_turn_rpm_ += e.PH[3] * step;
  for (int r = 0; r < kStates; ++r)
    for (int c = 0; c < kStates; ++c) P_[r][c] -= e.PH[r] * e.PH[c] / e.S;
}

// The object's origin is at base - R b, with R the object's heading as the base's own has it.
BaseTracker::Innovation BaseTracker::place_innovation(const Pose2& object, int axis) const {
  const Pose2& b = fit_.T_object_base;
  const SinCos h = sin_cos(base_.yaw - b.yaw);
  const double rx = h.cos * b.x - h.sin * b.y, ry = h.sin * b.x + h.cos * b.y;
  const double error = axis == 0 ? object.x - (base_.x - rx) : object.y - (base_.y - ry);
  const double H[kStates] = {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 0 ? ry : -rx, 0};
  return innovation(error, H, kPlaceSigma_m);
}

// Both coordinates correct, or neither does: one that fits by chance says nothing about a place that does
// not.
void BaseTracker::correct_place(const Pose2& object) {
  const Innovation x = place_innovation(object, 0), y = place_innovation(object, 1);
  double S_xy = 0;
  for (int r = 0; r < kStates; ++r) S_xy += x.H[r] * y.PH[r];
  // e' S^-1 e
  const double sigmas2 = (y.S * squared(x.error) - 2 * S_xy * x.error * y.error + x.S * squared(y.error)) /
                         (x.S * y.S - squared(S_xy));
  seen_ = squared(x.error) + squared(y.error) <= squared(kPlaceGate_m) || sigmas2 <= squared(kGateSigmas);
  if (!seen_) return refuse(compose(object, fit_.T_object_base));
  refused_ = 0;
  correct(x);
  correct(place_innovation(object, 1));
}

// Somebody may have carried the robot: a base that goes on by the wheels from where it was refused first is
// believed in the end. A thing that stands where the robot should drive is not it, however well it stands.
void BaseTracker::refuse(const Pose2& base) {
  const double apart2_m2 = squared(base.x - refused_base_.x) + squared(base.y - refused_base_.y);
  if (refused_ > 0 && apart2_m2 <= squared(kPlaceGate_m)) {
    ++refused_;
  } else {
    refused_ = 1;
    refused_base_ = base;
  }
  if (refused_ <= kMostRefused) return;
  begin_at(base);
  seen_ = true;
}

// The travel by the wheels, the turn by the camera: a wheel that is too large turns the robot, but hardly
// changes its way.
void BaseTracker::learn(const WheelOdometry& wheels, const Pose2& object, bool true_heading) {
  if (!had_heading_ || !wheels.valid || !true_heading) {
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
  if (wheels.valid)
    predict(wheels.forward_m, wheels.turn_rad);
  else
    predict(told_v_mps * wheels.dt_s, told_w_rps * wheels.dt_s);
  seen_ = false;
  bool true_heading = false;
  if (object != nullptr && object->good) {
    correct_place(object->pose);
    const double turn = wrap_angle(object->pose.yaw + fit_.T_object_base.yaw - base_.yaw);
    const Innovation heading = innovation(turn, {0, 0, 1, 0}, kHeadingSigma_rad);
    true_heading = seen_ && object->has_heading &&
                   (std::fabs(turn) <= kHeadingGate_rad || turn * turn <= squared(kGateSigmas) * heading.S);
    if (true_heading) correct(heading);
    learn(wheels, object->pose, true_heading);
    object_ = object->pose;
  }
  had_heading_ = true_heading;
}

}  // namespace st
