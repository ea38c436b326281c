// What goes out: a row per confirmed object and frame.
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

constexpr int kLongestGap = 6;  // frames for which a predicted pose is published

// Covariance of the pose in the floor's axes: position sigma, and sigma about those axes.
void floor_sigmas(const double (&covariance)[36], const Mat3& R_floor_camera, Vec3& position, Vec3& turn) {
  for (int i = 0; i < 3; ++i) {
    double p = 0, w = 0;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        p += R_floor_camera(i, r) * covariance[6 * r + c] * R_floor_camera(i, c);
        w += R_floor_camera(i, r) * covariance[6 * (3 + r) + 3 + c] * R_floor_camera(i, c);
      }
    position[i] = p > 0 ? std::sqrt(p) : 0;
    turn[i] = w > 0 ? std::sqrt(w) : 0;
  }
}

// Covariance of a pose (position, rotation about the camera's axes) with its origin moved by `arm`: a turn w
// moves it by w x arm.
void move_origin(const double (&from)[36], const Vec3& arm, double (&to)[36]) {
  const double J[3][3] = {{0, arm.z, -arm.y}, {-arm.z, 0, arm.x}, {arm.y, -arm.x, 0}};
  double rows[36];
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) {
      rows[6 * r + c] = from[6 * r + c];
      for (int i = 0; r < 3 && i < 3; ++i) rows[6 * r + c] += J[r][i] * from[6 * (3 + i) + c];
    }
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) {
      to[6 * r + c] = rows[6 * r + c];
      for (int i = 0; c < 3 && i < 3; ++i) to[6 * r + c] += rows[6 * r + 3 + i] * J[c][i];
    }
}

// What no single alignment knows of its error: the model was built from poses of the same tracker, and is off
// by as much as they were. Chosen so that squared errors are as large as they claim to be (normalised
// estimation error squared near one) over the simulated scenes; position grows with the sensor's noise.
constexpr double kModelPosition_per_m = 0.00015, kModelTurn_rad = 0.007, kModelTilt_rad = 0.0005;

void add_model_error(const Vec3& up, double distance_m, double (&covariance)[36]) {
  const double position = kModelPosition_per_m * distance_m * distance_m;
  constexpr double kTilt2 = kModelTilt_rad * kModelTilt_rad, kTurn2 = kModelTurn_rad * kModelTurn_rad;
  for (int i = 0; i < 3; ++i) {
    covariance[7 * i] += position * position;
    covariance[7 * (3 + i)] += kTilt2;
    for (int j = 0; j < 3; ++j) covariance[6 * (3 + i) + 3 + j] += (kTurn2 - kTilt2) * up[i] * up[j];
  }
}

}  // namespace

void ObjectTracker::see(SeenObjects& objects) const {
  for (const Track& track : tracks_) {
    if (track.id == 0 || !has_floor_frame_) continue;
    // In the frame that is published: a recognised object keeps the one that it had.
    const Pose T = T_floor_camera_ * track.T_camera_object * track.T_model_object;
    const Vec3 middle =
        track.T_model_object.inverse() * (track.bounds.empty() ? Vec3{} : track.bounds.centre());
    SeenObject object;
    object.id = track.id;
    object.good = track.phase == Track::Phase::kTracked && track.state == TrackState::kGood;
    object.has_heading = track.yaw_source != YawSource::kNone;
    object.pose = {T.t.x, T.t.y, to_roll_pitch_yaw(T.R).z};
    object.guess = {middle.x, middle.y, 0.05};
    objects.push_back(object);
  }
}

ObjectSample ObjectTracker::sample_of(Track& track) const {
  ObjectSample s;
  s.id = track.id;
  s.in_view = !track.left_view;
  const bool tracked = track.phase == Track::Phase::kTracked;
  if (tracked && track.state == TrackState::kGood) {
    s.state = TrackState::kGood;
    track.published_gap = 0;
  } else if (tracked && !tracks_by_matches() && track.published_gap < kLongestGap &&
             track.poor_run <= kLongestGap) {
    s.state = TrackState::kPredicted;
    ++track.published_gap;
  } else {
    s.state = tracked && track.state == TrackState::kPoor ? TrackState::kPoor : TrackState::kLost;
    return s;
  }
  s.in_tum = true;
  // A recognised object keeps the frame that it had: poses, rates and covariance are those of its origin.
  s.T_camera_object = track.T_camera_object * track.T_model_object;
  s.T_floor_object = T_floor_camera_ * s.T_camera_object;
  const Vec3 arm = s.T_camera_object.t - track.T_camera_object.t;
  double own[36], covariance[36];
  track.motion.covariance(own);
  if (s.state == TrackState::kGood)
    for (int i = 0; i < 36; ++i) own[i] = track.aligned.covariance[i];
  add_model_error(support_.up, track.T_camera_object.t.z, own);
  move_origin(own, arm, covariance);
  int k = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) s.covariance[k++] = covariance[6 * i + j];
  floor_sigmas(covariance, T_floor_camera_.R, s.sigma_position_m, s.sigma_rpy_rad);
  const double yaw = to_roll_pitch_yaw(s.T_floor_object.R).z;
  track.yaw_unwrapped += wrap_angle(yaw - track.yaw_unwrapped);
  s.yaw_unwrapped = track.yaw_unwrapped;
  const MotionOutput& motion = track.motion.output();
  s.velocity_mps = motion.velocity_mps + cross(motion.angular_velocity_rps, T_floor_camera_.R * arm);
  s.angular_velocity_rps = motion.angular_velocity_rps;
  s.acceleration_mps2 = motion.acceleration_mps2;
  s.v_mps = std::sqrt(s.velocity_mps.x * s.velocity_mps.x + s.velocity_mps.y * s.velocity_mps.y);
  s.w_rps = motion.angular_velocity_rps.z;
  s.alpha_rps2 = motion.turn_acceleration_rps2.z;
  s.yaw_source = track.state == TrackState::kGood ? track.yaw_source : YawSource::kNone;
  s.inliers = track.agreement.explained;
  s.residual_m = static_cast<float>(track.aligned.depth.rms_m);
  return s;
}

ObjectCount* ObjectTracker::count_of(int id) {
  const auto at = static_cast<std::size_t>(id - 1);
  return at < counts_.size() ? &counts_[at] : nullptr;
}

void ObjectTracker::publish(FrameReport& report) {
  report.objects.clear();
  for (Track& track : tracks_) {
    if (track.id == 0 || track.phase == Track::Phase::kFree) continue;
    const ObjectSample sample = sample_of(track);
    report.objects.push_back(sample);
    ObjectCount* const counted = count_of(track.id);
    if (counted == nullptr) continue;
    ObjectCount& count = *counted;
    if (sample.in_tum) count.last_t_s = report.t_s, ++count.tracked;
    if (!sample.in_tum && sample.in_view) ++count.lost;
    if (track.active() && track.aligned.iterations > 0) {
      ++count.aligned;
      count.iterations += static_cast<std::uint64_t>(track.aligned.iterations);
    }
    count.good_at_end = sample.state == TrackState::kGood;
    count.left_view = !sample.in_view;
  }
  for (const Event& event : events_) report.events.push_back(event);
}

}  // namespace st
