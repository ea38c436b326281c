#include "firmware_like/object_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "algo/depth/preprocess.hpp"
#include "algo/tracking/image_box.hpp"

namespace st {
namespace {

constexpr int kViewMargin_px = 14;
constexpr int kFramesPerSide = 20, kFirstFrames = 10, kHardlySmeared = 30;
// Share of the model that the frame sees through: it has to be carved away.
constexpr float kContradicted = 0.1f;
constexpr int kMostBalance = 90;  // frames: a long time whole must not outweigh being cut for ever

// On its way, or on the spot where its turn is seen: one that is not seen wanders.
bool moved_since_birth(const Track& track) {
  constexpr double kWay_m = 0.008, kTurn_rad = 0.15;
  const Pose &now = track.T_camera_object, &then = track.T_birth;
  if (norm(now.t - then.t) > kWay_m) return true;
  return track.yaw_source != YawSource::kNone && rotation_angle(now.R * then.R.transposed()) > kTurn_rad;
}

}  // namespace

ObjectTracker::ObjectTracker(const Calibration& calibration, const LoopConfig& config)
    : parts_{{this, &ObjectTracker::bind_images},      {this, &ObjectTracker::bind_segmenter},
             {this, &ObjectTracker::bind_volumes},     {this, &ObjectTracker::bind_views},
             {this, &ObjectTracker::bind_points},      {this, &ObjectTracker::bind_integration},
             {this, &ObjectTracker::bind_recognition}, {this, &ObjectTracker::bind_seen_features}},
      calibration_(calibration),
      config_(config) {
  if (config_.volume_side == 0) config_.volume_side = 128;
  frame_.camera = Pinhole::of(calibration.depth);
}

void ObjectTracker::start() {
  segmenter_.configure(calibration_);
  registration_.configure(calibration_);
  support_ = make_support({0, -1, 0}, 0, false);
}

std::span<ObservedPoint> ObjectTracker::points_of(std::size_t k) {
  return points_.subspan(k * kMaxPoints, kMaxPoints);
}

void ObjectTracker::preprocess(const FrameInput& input, FrameReport& report) {
  events_.clear();
  frame_.input = &input;
  frame_.color = {input.color};
  frame_.has_color = calibration_.has_color && !input.color.empty();
  frame_.color_lag_s = input.color_device_t_s - input.device_t_s;
  const CleanDepth& depth = segmenter_.preprocess(input);
  report.invalid_pixels = depth.invalid_pixels;
  to_metres(segmenter_.tables(), depth.code, frame_.depth_z);
}

void ObjectTracker::segment() {
  segmentation_ = &segmenter_.segment(*frame_.input, frame_.owners);
  update_support();
}

// The floor is learned again and again until the first object is confirmed; then it holds still, because
// every frame that was published stands on it.
void ObjectTracker::update_support() {
  if (support_frozen_) return;
  const Floor& floor = segmentation_->floor;
  if (floor.found) {
    support_ = make_support(floor.n, floor.d, true);
  } else if (frame_.input->has_gravity) {
    support_ = make_support(frame_.input->gravity_mps2, 0, false);
  }
}

void ObjectTracker::predict() {
  for (Track& track : tracks_) {
    if (!track.active()) continue;
    const MotionNoise noise = ask_wheels(track)          ? kWheeledNoise
                              : track.drive.recognised() ? kDrivingNoise
                                                         : MotionNoise{};
    track.motion.predict(frame_.input->device_t_s, noise);
  }
}

void ObjectTracker::render_one(Track& track, const Pose& T) {
  track.rendered.T_camera_object = T;
  const Rect box = visible_rect(track.volume, frame_.camera, T);
  track.view_pixels = raycast(track.volume, frame_.camera, box.grown(kViewMargin_px), T, raycast_scratch_,
                              track.rendered.maps)
                          .hits;
  track.view = track.rendered;
}

void ObjectTracker::render() {
  for (std::size_t k = 0; k < kMaxObjects; ++k) {
    Track& track = tracks_[k];
    if (!track.active()) continue;
    if (config_.tracker == TrackerKind::kFrameToFrame && previous_[k].surface_pixels > 0) {
      track.view = previous_[k].view;
      track.view_pixels = previous_[k].surface_pixels;
    } else {
      render_one(track, track.motion.pose());
    }
  }
}

void ObjectTracker::associate_pixels() {
  const AssociationInput input{segmentation_->labels,
                               {segmentation_->segments.begin(), segmentation_->segments.size()},
                               frame_.depth_z,
                               frame_.camera};
  associate(input, tracks_, frame_.owners, owned_, unexplained_);
  for (std::size_t k = 0; k < kMaxObjects; ++k) {
    if (!tracks_[k].active() || owned_[k].pixels == 0) continue;
    tracks_[k].owned_pixels = owned_[k].pixels;
    tracks_[k].divided_run = owned_[k].divided ? tracks_[k].divided_run + 1 : 0;
    const int balance = tracks_[k].cut_balance + (is_cut(owned_[k].box, segmentation_->view) ? 1 : -1);
    tracks_[k].cut_balance = std::clamp(balance, -kMostBalance, kMostBalance);
  }
}

AlignInput ObjectTracker::alignment_of(const Track& track, std::size_t k) const {
  AlignInput in;
  in.points = points_.subspan(k * kMaxPoints, track.points_used);
  in.view = track.view;
  in.depth_z = frame_.depth_z;
  in.camera = frame_.camera;
  in.prior = track.motion.prior();
  in.start = in.prior.mean;
  in.pivot = in.prior.mean.t;
  in.color_time = track.motion.color_time(frame_.color_lag_s);
  in.floor.on = track.planar && support_.found && config_.use_floor;
  in.floor.up_camera = support_.up;
  in.floor.d = support_.d;
  in.terms = {config_.use_contour, config_.use_floor, config_.use_motion};
  if (config_.use_color && !color_frame_.empty()) in.color = &color_frame_;
  const double sigma = 2.0 * track.motion.position_sigma_m();
  in.largest_start_error_m = sigma < 0.02 ? 0.02 : sigma > 0.08 ? 0.08 : sigma;
  return in;
}

void ObjectTracker::align_one(Track& track, std::size_t k, const LadderStep& step) {
  observe(track, k, owned_[k].box);
  track.aligned = AlignResult{};
  if (track.points_used < kLeastPoints || track.view_pixels < kLeastPoints) return;
  AlignInput in = alignment_of(track, k);
  in.point_stride = step.point_stride;
  // The paper's alignment knows no floor, and needs nothing to leave it.
  if (config_.tracker == TrackerKind::kListing1) {
    track.aligned = align_closest_point(in, clouds_[k], scratch_);
    return;
  }
  expect_heading(track, in);
  track.aligned = align(in, scratch_);
  if (step.point_stride == 1) look_beside(track, in, k);
  defend_heading(track, in);
  if (in.floor.on && step.point_stride == 1) leave_floor(track, in);
}

void ObjectTracker::observe(Track& track, std::size_t k, const Rect& box) {
  const std::uint8_t owner = static_cast<std::uint8_t>(k + 1);
  if (config_.use_cleaning) mark_edges(frame_.depth_z, owner, box, frame_.owners);
  track.points_used = gather_points(frame_.depth_z, frame_.owners, owner, box, frame_.camera, points_of(k));
}

// A hand that takes hold of an object hangs together with it. Meanwhile neither pixels beside the model, as
// it lies at the pose just found, nor any outside of its known extent are new surface of it.
void ObjectTracker::keep_shape(const Track& track, std::size_t k) {
  const PoseF T_object_camera = to_float(track.T_camera_object.inverse());
  const PoseF T_view_object = to_float(track.view.T_camera_object);
  const Rect box = owned_[k].box;
  for (int v = box.v0; v < box.v1; ++v) {
    for (int u = box.u0; u < box.u1; ++u) {
      if (frame_.owners(u, v) != k + 1) continue;
      const Vec3f p = T_object_camera * (frame_.camera.ray(static_cast<float>(u), static_cast<float>(v)) *
                                         frame_.depth_z(u, v));
      const Pinhole::Pixel at = frame_.camera.pixel_of(T_view_object * p);
      bool on_model = false;
      for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du) on_model = on_model || track.view.z(at.u + du, at.v + dv) > 0;
      if (!on_model || !track.bounds.contains(to_double(p))) frame_.owners(u, v) = kEdge;
    }
  }
}

// The frame goes into the model at the pose just found.
void ObjectTracker::fuse(Track& track, std::size_t k) {
  Rect box = image_box(track.bounds, track.T_camera_object, frame_.camera, kViewMargin_px);
  for (const ObservedPoint& point : points_of(k).first(track.points_used)) box.include(point.u, point.v);
  EvidenceInput evidence;
  evidence.camera = frame_.camera;
  evidence.roi = box.clipped(frame_.depth_z.width, frame_.depth_z.height);
  evidence.depth_m = frame_.depth_z;
  evidence.owners = frame_.owners;
  evidence.object = static_cast<std::uint8_t>(k + 1);
  evidence.color = register_colors(k, evidence.roi);
  note_integrated(track, integrate(track.volume, evidence, track.T_camera_object, IntegrateOptions{},
                                   integrate_scratch_));
}

// The averaged view of a thing at rest, before anything touched it; rest_z_ holds it, alone.
void ObjectTracker::fuse_at_rest(Track& track, const Rect& box) {
  EvidenceInput evidence;
  evidence.camera = frame_.camera;
  evidence.roi = box;
  evidence.depth_m = rest_z_;
  note_integrated(track, integrate(track.volume, evidence, track.T_camera_object, IntegrateOptions{},
                                   integrate_scratch_));
}

void ObjectTracker::note_integrated(Track& track, const IntegrateStats& stats) {
  ++track.integrated;
  if (config_.tracker == TrackerKind::kListing1) clouds_[&track - tracks_].take(track.volume);
  if (stats.low.x <= stats.high.x) {
    track.bounds.include(to_double(stats.low));
    track.bounds.include(to_double(stats.high));
  }
  if (stats.outside_pixels * 50 < stats.surface_pixels) return;
  // More than two percent fell outside of the box: it was placed by what was seen first. Move it, if that
  // helps.
  const BrickShift shift = shift_towards(track.volume, to_float(track.bounds.centre()));
  if (shift.x != 0 || shift.y != 0 || shift.z != 0) {
    recentre(track.volume, shift);
  } else if (!track.told_full) {
    track.told_full = true;
    log(EventKind::kVolumeFull, track.id, stats.outside_pixels);
  }
}

void ObjectTracker::align_all(const LadderStep& step) {
  Rect seen = Rect::nothing();
  for (std::size_t k = 0; k < kMaxObjects; ++k) {
    if (!tracks_[k].active()) continue;
    seen.include(owned_[k].box);
    seen.include(tracks_[k].view.maps.roi);
  }
  look_at_colors(seen.clipped(frame_.depth_z.width, frame_.depth_z.height), step);
  for (std::size_t k = 0; k < kMaxObjects; ++k)
    if (tracks_[k].active())
      tracks_by_matches() ? align_by_matches(tracks_[k], k) : align_one(tracks_[k], k, step);
}

void ObjectTracker::judge_one(Track& track) {
  const Pose D = track.aligned.T_camera_object * track.view.T_camera_object.inverse();
  track.agreement = compare(track.view, frame_.camera, frame_.depth_z, D, track.aligned.depth);
  track.verdict = judge(track.aligned, track.agreement, track.habit);
  if (judge(track.aligned, track.agreement) == Verdict::kGood)
    track.habit.learn(track.aligned, track.agreement);
  if (track.verdict != Verdict::kGood) {
    track.state = track.verdict == Verdict::kPoor ? TrackState::kPoor : TrackState::kLost;
    ++track.poor_run;
    track.motion.coast(0.8);
    track.T_camera_object = track.motion.pose();
    return;
  }
  if (!track.planar) return_to_floor(track);
  track.yaw_source = yaw_source_of(track.aligned, support_.up);
  judge_wheels(track);
  track.motion.correct(track.aligned.T_camera_object, track.aligned.covariance, track.aligned.color_rest,
                       frame_.color_lag_s);
  track.T_camera_object = track.aligned.T_camera_object;
  track.state = TrackState::kGood;
  track.poor_run = 0;
  ++track.good_poses;
  track.last_good_t_s = frame_.input->t_s;
  track.T_last_good = track.T_camera_object;
  if (track.planar && support_.found)
    track.drive.add(frame_.input->device_t_s, support_.on_floor(track.T_camera_object), track.heading_doubt);
  track.has_moved = track.has_moved || moved_since_birth(track);
}

void ObjectTracker::judge_all() {
  for (Track& track : tracks_)
    if (track.active()) tracks_by_matches() ? judge_matches(track) : judge_one(track);
  match_wheels();
}

void ObjectTracker::integrate_all(const LadderStep& step) {
  if (tracks_by_matches()) return;  // no model is kept
  for (std::size_t k = 0; k < kMaxObjects; ++k) {
    Track& track = tracks_[k];
    if (!track.active() || track.state != TrackState::kGood || !step.integrate) continue;
    // While the turn is unseen, a new view would smear over the model for ever. The first frames have nothing
    // to smear.
    const bool unsure = track.yaw_source == YawSource::kNone || track.heading_doubt;
    std::uint8_t& fused = track.sides.side_of(track.T_camera_object);
    const bool contradicted = track.agreement.through > kContradicted;
    const bool wanted = fused < kFramesPerSide || track.integrated < kFirstFrames || contradicted;
    if (wanted && !(unsure && track.integrated > kHardlySmeared)) {
      if (owned_[k].divided) keep_shape(track, k);
      fuse(track, k);
      fused = static_cast<std::uint8_t>(fused + (fused < 255));
    }
    if (config_.tracker == TrackerKind::kFrameToFrame) remember(track, k);
  }
}

// Frame-to-frame mode: what the coming frames are aligned with.
void ObjectTracker::remember(const Track& track, std::size_t k) {
  if (++previous_[k].age <= config_.keyframe_every) return;
  const Rect box = image_box(track.bounds, track.T_camera_object, frame_.camera, kViewMargin_px);
  remember_frame(previous_[k], frame_.depth_z, frame_.owners, static_cast<std::uint8_t>(k + 1), box,
                 frame_.camera, register_colors(k, box), track.T_camera_object);
}

}  // namespace st
