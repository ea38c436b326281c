// Constant-velocity motion of one object with white acceleration noise: predicts the pose of the next frame
// and how far to trust it, and learns from the pose that the alignment found. Six independent axes: position
// of the object's origin and turn, both along the axes of a fixed reference frame (the floor's, where there
// is one).
#pragma once

#include "algo/core/pose.hpp"
#include "algo/tracking/align.hpp"

namespace st {

// One-sigma accelerations: of hands and legs, and of what has been seen to drive on wheels.
struct MotionNoise {
  double acceleration_mps2 = 1.0;
  double turn_acceleration_rps2 = 5.0;
};
inline constexpr MotionNoise kDrivingNoise{0.7, 5.0};
// The same while the wheels tell the turn, which is then no matter of acceleration.
inline constexpr MotionNoise kWheeledNoise{0.7, 0.3};

// Smoothed rates for publishing, reference axes. First-order low-pass filters: velocity lags by 67 ms,
// acceleration by 200 ms more at 30 frames a second.
struct MotionOutput {
  Vec3 velocity_mps{}, angular_velocity_rps{}, acceleration_mps2{}, turn_acceleration_rps2{};
};

class MotionFilter {
 public:
  // Starts at rest. R_reference_camera: axes in which the filter works.
  void start(const Pose& T_camera_object, const Mat3& R_reference_camera, double t_s);

  // After a search: it may have moved on since, at these rates (reference axes) or at any others.
  void start_found(const Vec3& velocity_mps, const Vec3& angular_velocity_rps);

  // Height and lean (the reference axes' z is up) are unknown anew.
  void leave_plane();

  // The orientation was wrong by this turn (camera frame) all along: no part of it is motion.
  void turn(const Mat3& by);
  // How fast it turns about the reference's z axis was wrong as well.
  void set_turn_rate(double rate_rps);

  // How fast it turns about the reference's z axis until the next prediction's time, told by its wheels.
  void turns_at(double rate_rps, double sigma_rps);

  // Another frame of the same body stands for it from now on: the rates are those of its origin.
  void rebase(const Pose& T_old_new);

  // Moves the estimate on to time t_s.
  void predict(double t_s, const MotionNoise& noise);

  // The prior for the alignment, from the predicted state.
  MotionPrior prior() const;

  // Takes the pose found by an alignment that already used prior(): its covariance (camera axes, about the
  // origin) is the posterior, so the rates follow by conditioning (no second use of the prior).
  // `rest`: what a colour image taken lag_s after (before: negative) said beyond that.
  void correct(const Pose& T_camera_object, const double (&covariance)[36], const TieRest& rest = {},
               double lag_s = 0);

  // Keeps the predicted pose and lets the rates fade: an object that nobody sees is not followed for long.
  void coast(double fade);
  void rest() { coast(0); }

  const Pose& pose() const { return pose_; }
  Vec3 velocity_mps() const { return {axis_[0].rate, axis_[1].rate, axis_[2].rate}; }  // reference axes
  Vec3 angular_velocity_rps() const {
    return {axis_[3].rate, axis_[4].rate, axis_[5].rate};
  }  // reference axes
  double t_s() const { return t_s_; }
  const MotionOutput& output() const { return output_; }
  // The object's motion over dt at the present rates, in the camera frame: p(t + dt) = motion * p(t).
  Pose motion_over(double dt_s) const;
  // How the pose at t_s() + lag_s, the time of a colour image, hangs together with that at t_s().
  ColorTime color_time(double lag_s) const;
  double position_sigma_m() const;
  // Of the pose as it stands, row-major 6x6: position, then turn, camera axes.
  void covariance(double (&out)[36]) const;

 private:
  struct Axis {
    double rate = 0;
    double pp = 0, pr = 0, rr = 0;  // covariance of (value, rate)
  };
  static constexpr Axis kUnknownPosition{0, 0.01 * 0.01, 0, 0.5 * 0.5}, kUnknownTurn{0, 0.05 * 0.05, 0, 1.0};
  Axis axis_[6];
  // Before the newest step of prediction, which took step_s_ with accelerations of these variances.
  Axis before_[6];
  double step_s_ = 0, step_variance_[6]{};
  Pose pose_;
  Mat3 R_reference_camera_;
  double t_s_ = 0;

  // Where an axis was lag_s from t_s_, beside where it is: variances of the value then and of its covariances
  // with value and rate now.
  struct Then {
    double variance, with_value, with_rate;
  };
  Then then(int axis, double lag_s) const;
  void in_camera_axes(bool inverse, double (&out)[36]) const;
  void update_output(const Pose& before, double dt_s);
  MotionOutput output_;
  Pose corrected_;  // newest corrected pose and its time, for the published rates
  double corrected_t_s_ = 0;
};

}  // namespace st
