#include "algo/tracking/drive_model.hpp"

#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kWindow_m = 0.04, kWindowTurn_rad = 0.25;
constexpr double kForget = 0.998;  // a window: the axis must not follow a heading that slides
constexpr int kMostMisfits = 12;   // half a metre of driving another way
constexpr double kMisfit_rad = 0.2;
constexpr double kLateralNoise_m = 0.003, kOffset_m = 0.05;  // of a window; of the turning centre, a priori
constexpr double kLeastTravel_m = 0.25, kMostLateral = 0.09;
constexpr double kLongestGap_s = 0.2;  // what came of it beyond that, nobody saw: a hand may have carried it
constexpr double kLongest_s = 1.0, kLeastWay_m = 0.10, kMostTurn_rad = 0.4;
constexpr double kChord_m = 0.05, kMostBend_rad = 0.3, kChordSigma_rad = 0.1;
constexpr double kPosition_m = 0.002, kLeastSigma_rad = 0.02;

}  // namespace

// On an arc the chord has the mean of both headings: seen from there, it is the motion in the object's axes.
void DriveModel::Motion::add_step(const Pose2& from, const Pose2& to) {
  const double turn = wrap_angle(to.yaw - from.yaw), x = to.x - from.x, y = to.y - from.y;
  const SinCos sc = sin_cos(from.yaw + 0.5 * turn);
  x_m += sc.cos * x + sc.sin * y;
  y_m += sc.cos * y - sc.sin * x;
  turn_rad += turn;
}

double DriveModel::Motion::length_m() const { return std::sqrt(x_m * x_m + y_m * y_m); }

// By how much the heading is off, if nothing but that makes the motion leave the axis, either way along it.
double DriveModel::heading_error(const Motion& motion, const Axis& axis) {
  double along = axis.cos * motion.x_m + axis.sin * motion.y_m;
  double across = axis.cos * motion.y_m - axis.sin * motion.x_m + axis.offset_m * motion.turn_rad;
  if (along < 0) along = -along, across = -across;
  return arc_tan2(across, along);
}

void DriveModel::learn(const Motion& window, bool doubt) {
  if (recognised() && window.length_m() > 0.5 * kWindow_m) {
    const bool misfit = std::fabs(heading_error(window, axis())) > kMisfit_rad;
    misfits_ = misfit ? misfits_ + 1 : 0;
    if (misfits_ > kMostMisfits) reset();
    if (misfit) return;
  }
  if (doubt) return;
  if (recognised()) backward_ = axis().cos * window.x_m + axis().sin * window.y_m < 0;
  const double a[3] = {window.x_m, window.y_m, window.turn_rad};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) scatter_[r][c] = kForget * scatter_[r][c] + a[r] * a[c];
  travel_m_ = kForget * travel_m_ + window.length_m();
}

void DriveModel::turn_recent(double by_rad) {
  for (Sample& sample : recent_) sample.pose.yaw = wrap_angle(sample.pose.yaw + by_rad);
  window_ = {};
}

void DriveModel::add(double t_s, const Pose2& pose, bool doubt) {
  if (!recent_.empty() && t_s - recent_[recent_.size() - 1].t_s > kLongestGap_s) {
    recent_.clear();
    window_ = {};
  }
  if (!recent_.empty()) window_.add_step(recent_[recent_.size() - 1].pose, pose);
  if (recent_.full()) recent_.erase(0);
  recent_.push_back({t_s, pose});
  if (window_.length_m() < kWindow_m && std::fabs(window_.turn_rad) < kWindowTurn_rad) return;
  const Motion window = window_;
  window_ = {};
  learn(window, doubt);
}

// The lateral motion -sin(phi) ax + cos(phi) ay + c s vanishes: c from the turns, what is left of (ax, ay) is
// a 2 x 2 matrix whose larger eigenvector is the driving axis.
DriveModel::Axis DriveModel::axis() const {
  const double turn = scatter_[2][2] + kLateralNoise_m * kLateralNoise_m / (kOffset_m * kOffset_m);
  const double xx = scatter_[0][0] - scatter_[0][2] * scatter_[0][2] / turn;
  const double xy = scatter_[0][1] - scatter_[0][2] * scatter_[1][2] / turn;
  const double yy = scatter_[1][1] - scatter_[1][2] * scatter_[1][2] / turn;
  const double half = 0.5 * (xx - yy), root = std::sqrt(half * half + xy * xy), mean = 0.5 * (xx + yy);
  const SinCos sc = sin_cos(0.5 * arc_tan2(xy, half));
  Axis axis;
  axis.cos = sc.cos;
  axis.sin = sc.sin;
  axis.offset_m = (sc.sin * scatter_[0][2] - sc.cos * scatter_[1][2]) / turn;
  const double along = mean + root, across = mean - root;
  axis.lateral = along > 0 && across > 0 ? std::sqrt(across / along) : along > 0 ? 0.0 : 1.0;
  return axis;
}

bool DriveModel::recognised() const { return travel_m_ >= kLeastTravel_m && axis().lateral < kMostLateral; }

// From the headings on the way, if they changed little: the motion along them, taken together, has to lie on
// the axis.
ExpectedHeading DriveModel::expect_by_headings(double t_s, const Pose2& predicted, const Axis& drive) const {
  Motion motion;
  const Pose2* later = &predicted;
  double begin_s = t_s;
  for (std::size_t i = recent_.size(); i > 0 && motion.length_m() < kLeastWay_m; --i) {
    const Sample& sample = recent_[i - 1];
    motion.add_step(sample.pose, *later);
    later = &sample.pose;
    begin_s = sample.t_s;
    if (t_s - sample.t_s > kLongest_s || std::fabs(motion.turn_rad) > kMostTurn_rad) return {};
  }
  if (motion.length_m() < kLeastWay_m) return {};
  const double noise = 1.5 * kPosition_m / motion.length_m();
  // Of the windows' lateral motion, what their own noise does not explain.
  const double slip2 =
      drive.lateral * drive.lateral - kLateralNoise_m * kLateralNoise_m / (kWindow_m * kWindow_m);
  return {true, wrap_angle(predicted.yaw + heading_error(motion, drive)),
          std::sqrt(noise * noise + (slip2 > 0 ? slip2 : 0.0) + kLeastSigma_rad * kLeastSigma_rad),
          motion.turn_rad / (t_s - begin_s)};
}

// From the places alone, when the headings spin: two chords, one after the other, give the direction and how
// it changes.
ExpectedHeading DriveModel::expect_by_places(double t_s, const Pose2& predicted, const Axis& drive) const {
  double direction[2], middle_s[2], end_s = t_s;
  Pose2 end = predicted;
  int chords = 0;
  for (std::size_t i = recent_.size(); i > 0 && chords < 2; --i) {
    const Sample& sample = recent_[i - 1];
    if (t_s - sample.t_s > kLongest_s) return {};
    const double x = end.x - sample.pose.x, y = end.y - sample.pose.y;
    if (x * x + y * y < kChord_m * kChord_m) continue;
    direction[chords] = arc_tan2(y, x);
    middle_s[chords++] = 0.5 * (end_s + sample.t_s);
    end = sample.pose;
    end_s = sample.t_s;
  }
  if (chords < 2) return {};
  const double bend = wrap_angle(direction[0] - direction[1]);
  if (std::fabs(bend) > kMostBend_rad) return {};
  double off = wrap_angle(direction[0] + 0.5 * bend - arc_tan2(drive.sin, drive.cos) - predicted.yaw);
  // Forward or backward: whichever it did lately, since headings that spin say nothing.
  if (backward_) off = wrap_angle(off + kPi);
  return {true, wrap_angle(predicted.yaw + off), kChordSigma_rad, bend / (middle_s[0] - middle_s[1])};
}

ExpectedHeading DriveModel::expect(double t_s, const Pose2& predicted) const {
  if (recent_.empty() || !recognised()) return {};
  const Axis drive = axis();
  const ExpectedHeading by_headings = expect_by_headings(t_s, predicted, drive);
  return by_headings.known ? by_headings : expect_by_places(t_s, predicted, drive);
}

}  // namespace st
