#include "algo/tracking/motion_filter.hpp"

#include <algorithm>
#include <cmath>

namespace st {
namespace {

constexpr double kLeastOpen = 1e-9;

}  // namespace

void MotionFilter::start(const Pose& T_camera_object, const Mat3& R_reference_camera, double t_s) {
  pose_ = T_camera_object;
  R_reference_camera_ = R_reference_camera;
  t_s_ = corrected_t_s_ = t_s;
  corrected_ = T_camera_object;
  output_ = MotionOutput{};
  step_s_ = 0;
  for (int i = 0; i < 6; ++i) before_[i] = axis_[i] = i >= 3 ? kUnknownTurn : kUnknownPosition;
}

void MotionFilter::start_found(const Vec3& velocity_mps, const Vec3& angular_velocity_rps) {
  constexpr double kMoved_m = 0.03, kTurned_rad = 0.1;
  for (int i = 0; i < 6; ++i) {
    axis_[i] = i >= 3 ? kUnknownTurn : kUnknownPosition;
    axis_[i].pp = i >= 3 ? kTurned_rad * kTurned_rad : kMoved_m * kMoved_m;
    axis_[i].rate = i >= 3 ? angular_velocity_rps[i - 3] : velocity_mps[i];
  }
}

void MotionFilter::leave_plane() {
  for (const int i : {2, 3, 4}) axis_[i] = i >= 3 ? kUnknownTurn : kUnknownPosition;
}

void MotionFilter::turn(const Mat3& by) {
  pose_.R = orthonormalized(by * pose_.R);
  corrected_.R = orthonormalized(by * corrected_.R);
}

void MotionFilter::set_turn_rate(double rate_rps) {
  const double pp = axis_[5].pp;
  axis_[5] = kUnknownTurn;
  axis_[5].pp = pp;
  axis_[5].rate = rate_rps;
  output_.angular_velocity_rps.z = rate_rps;
}

void MotionFilter::turns_at(double rate_rps, double sigma_rps) {
  axis_[5].rate = rate_rps;
  axis_[5].pr = 0;
  axis_[5].rr = sigma_rps * sigma_rps;
}

void MotionFilter::rebase(const Pose& T_old_new) {
  const Vec3 arm = R_reference_camera_ * (pose_.R * T_old_new.t);
  const Vec3 more = cross(angular_velocity_rps(), arm);
  for (int i = 0; i < 3; ++i) axis_[i].rate += more[i], before_[i].rate += more[i];
  output_.velocity_mps += cross(output_.angular_velocity_rps, arm);
  pose_ = pose_ * T_old_new;
  corrected_ = corrected_ * T_old_new;
}

Pose MotionFilter::motion_over(double dt_s) const {
  const Mat3 R_camera_reference = R_reference_camera_.transposed();
  const Mat3 dR = rotation_from_vector(R_camera_reference * (angular_velocity_rps() * dt_s));
  const Vec3 v = R_camera_reference * (velocity_mps() * dt_s);
  return {dR, pose_.t + v - dR * pose_.t};
}

// The value then is x + r s + a s^2 / 2 of the state before the step, s after it, with the acceleration a of
// the step.
MotionFilter::Then MotionFilter::then(int axis, double lag_s) const {
  const Axis& a = before_[axis];
  const double dt = step_s_, s = dt + lag_s, q = step_variance_[axis];
  const double bend = s > 0 ? 0.5 * s * s : 0.0;
  return {a.pp + 2 * s * a.pr + s * s * a.rr + bend * bend * q,
          a.pp + (dt + s) * a.pr + dt * s * a.rr + 0.5 * dt * dt * bend * q, a.pr + s * a.rr + dt * bend * q};
}

ColorTime MotionFilter::color_time(double lag_s) const {
  ColorTime time;
  time.motion = motion_over(lag_s);
  time.tie.R_frame_camera = R_reference_camera_;
  for (int i = 0; i < 6; ++i) {
    const Then t = then(i, lag_s);
    time.tie.share[i] = t.with_value / axis_[i].pp;
    const double rest = t.variance - time.tie.share[i] * t.with_value;
    time.tie.sigma[i] = rest > 0 ? std::sqrt(rest) : 0;
  }
  return time;
}

void MotionFilter::predict(double t_s, const MotionNoise& noise) {
  const double dt = t_s - t_s_;
  if (!(dt > 0)) return;
  pose_ = motion_over(dt) * pose_;
  pose_.R = orthonormalized(pose_.R);
  t_s_ = t_s;
  step_s_ = dt;
  for (int i = 0; i < 6; ++i) {
    Axis& a = axis_[i];
    before_[i] = a;
    const double sigma = i < 3 ? noise.acceleration_mps2 : noise.turn_acceleration_rps2;
    // An acceleration that holds for a frame and then changes (piecewise constant).
    const double q = sigma * sigma;
    step_variance_[i] = q;
    a.pp += 2 * dt * a.pr + dt * dt * a.rr + 0.25 * dt * dt * dt * dt * q;
    a.pr += dt * a.rr + 0.5 * dt * dt * dt * q;
    a.rr += dt * dt * q;
    // No object is faster than that; its covariance with the value must not say more than the variance does,
    // or a long gap would leave negative ones.
    const double most = i < 3 ? 4.0 : 25.0;  // (2 m/s)^2, (5 rad/s)^2
    if (!(a.rr > most)) continue;
    constexpr double kMostCorrelation = 0.9;
    a.rr = most;
    a.pr = std::min(a.pr, kMostCorrelation * std::sqrt(a.pp * a.rr));
  }
}

// The diagonal of the axes' values, or of their inverses, turned from the reference axes to the camera's.
void MotionFilter::in_camera_axes(bool inverse, double (&out)[36]) const {
  const Mat3& R = R_reference_camera_;
  for (double& x : out) x = 0;
  for (int block = 0; block < 6; block += 3)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) {
          const double pp = axis_[block + k].pp;
          out[6 * (block + r) + block + c] += R(k, r) * R(k, c) * (inverse ? 1 / pp : pp);
        }
}

MotionPrior MotionFilter::prior() const {
  MotionPrior prior;
  prior.mean = pose_;
  in_camera_axes(true, prior.information);
  return prior;
}

void MotionFilter::covariance(double (&out)[36]) const { in_camera_axes(false, out); }

// The rate is alpha times the value's deviation, plus beta times the rest of the colour image's, plus what
// neither tells; value and rest are independent before the frame, and no more so after it.
void MotionFilter::correct(const Pose& T_camera_object, const double (&covariance)[36], const TieRest& rest,
                           double lag_s) {
  const Mat3& R = R_reference_camera_;
  const Vec3 moved = R * (T_camera_object.t - pose_.t);
  const Vec3 turned = R * rotation_to_vector(T_camera_object.R * pose_.R.transposed());
  for (int i = 0; i < 6; ++i) {
    Axis& a = axis_[i];
    const int block = i / 3, k = i % 3;
    double posterior = 0;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        posterior += R(k, r) * covariance[6 * (3 * block + r) + 3 * block + c] * R(k, c);
    if (!(posterior > 0) || posterior > a.pp) posterior = a.pp;
    const double alpha = a.pr / a.pp;
    const Then t = then(i, lag_s);
    const double share = t.with_value / a.pp, open = t.variance - share * t.with_value;
    // No colour image, or one of the same time.
    const bool blind = !rest.told || !(open > kLeastOpen * t.variance);
    const double beta = blind ? 0.0 : (t.with_rate - share * a.pr) / open;
    const double joint = rest.slope[i] * posterior;
    const double rest_variance = blind ? 0.0 : rest.variance[i] + rest.slope[i] * joint;
    const double shift = block == 0 ? moved[k] : turned[k];
    a.rate += alpha * shift + beta * rest.mean[i];
    a.rr += alpha * alpha * (posterior - a.pp) + beta * beta * (rest_variance - (blind ? 0.0 : open)) +
            2 * alpha * beta * joint;
    a.pr = alpha * posterior + beta * joint;
    a.pp = posterior;
  }
  pose_ = T_camera_object;
  update_output(corrected_, t_s_ - corrected_t_s_);
  corrected_ = pose_;
  corrected_t_s_ = t_s_;
}

void MotionFilter::update_output(const Pose& before, double dt_s) {
  if (!(dt_s > 0)) return;
  const Mat3& R = R_reference_camera_;
  const Vec3 v = R * (pose_.t - before.t) * (1 / dt_s);
  const Vec3 w = R * rotation_to_vector(pose_.R * before.R.transposed()) * (1 / dt_s);
  const double share_v = dt_s / (0.067 + dt_s), share_a = dt_s / (0.2 + dt_s);
  const MotionOutput old = output_;
  output_.velocity_mps += (v - old.velocity_mps) * share_v;
  output_.angular_velocity_rps += (w - old.angular_velocity_rps) * share_v;
  const Vec3 a = (output_.velocity_mps - old.velocity_mps) * (1 / dt_s);
  const Vec3 alpha = (output_.angular_velocity_rps - old.angular_velocity_rps) * (1 / dt_s);
  output_.acceleration_mps2 += (a - old.acceleration_mps2) * share_a;
  output_.turn_acceleration_rps2 += (alpha - old.turn_acceleration_rps2) * share_a;
}

void MotionFilter::coast(double fade) {
  for (Axis& a : axis_) a.rate *= fade;
}

double MotionFilter::position_sigma_m() const {
  const double largest = std::max(axis_[0].pp, std::max(axis_[1].pp, axis_[2].pp));
  return std::sqrt(largest);
}

}  // namespace st
