#include "firmware_like/scan_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace st {
namespace {

constexpr int kScanSide = 256;
// A room does not change: what was seen often is to be held as long as a byte can count.
constexpr IntegrateOptions kIntegrate{.noise = {}, .weight_cap = kMaxWeightCap};
// The finest level of the pyramid that a late frame is looked at on.
int finest(const LadderStep& step) { return step.point_stride > 1 ? 1 : 0; }

constexpr float kMaxExtent_m = 8, kMinExtent_m = 0.8f;

// The share `q` of the readings is nearer than this. Of every 7th pixel, in 1 cm steps.
float depth_quantile_m(ImageView<const float> z, double q) {
  constexpr int kBins = 1001;
  int counts[kBins]{}, all = 0;
  for (int i = 0; i < z.pixels(); i += 7) {
    if (!(z.data[i] > 0)) continue;
    ++counts[std::min(kBins - 1, static_cast<int>(z.data[i] * 100))];
    ++all;
  }
  int below = 0, bin = 0;
  while (bin < kBins - 1 && below + counts[bin] < static_cast<int>(q * all)) below += counts[bin++];
  return static_cast<float>(bin) * 0.01f;
}

}  // namespace

ScanTracker::ScanTracker(const Calibration& calibration, const LoopConfig& config)
    : parts_{{this, &ScanTracker::bind_images},
             {this, &ScanTracker::bind_volume},
             {this, &ScanTracker::bind_view},
             {this, &ScanTracker::bind_integration}},
      calibration_(calibration),
      config_(config),
      camera_(Pinhole::of(calibration.depth)) {
  if (config_.volume_side == 0) config_.volume_side = kScanSide;
}

void ScanTracker::plan_memory(MemoryPlan& plan) {
  plan.add("images of the frame", "algo/depth", parts_[0]);
  plan.add("the scene, one volume", "algo/volume", parts_[1]);
  plan.add("view of the scene", "algo/volume", parts_[2]);
  plan.add("work memory of the fusion", "algo/volume", parts_[3]);
}

void ScanTracker::bind_images(Bump& memory) {
  tables_.bind(memory, calibration_);
  depth_.bind(memory, camera_);
  if (calibration_.has_color)
    color_ = {memory
                  .take<std::uint32_t>(static_cast<std::size_t>(camera_.width) *
                                       static_cast<std::size_t>(camera_.height))
                  .data(),
              camera_.width, camera_.height};
}

void ScanTracker::bind_volume(Bump& memory) { volume_.bind(memory, config_.volume_side); }

void ScanTracker::bind_view(Bump& memory) {
  view_.bind(memory, camera_.width, camera_.height);
  raycast_scratch_.bind(memory, camera_.width, camera_.height);
  places_.bind(memory);
}

void ScanTracker::bind_integration(Bump& memory) {
  integrate_scratch_.bind(memory, camera_.width, camera_.height, config_.volume_side);
}

void ScanTracker::start() {
  tables_.configure(calibration_);
  // Clears all of it once, before the first frame waits for it.
  volume_.reset(0.01f, 0.04f, {});
}

void ScanTracker::preprocess(const FrameInput& input, FrameReport& report) {
  input_ = &input;
  events_.clear();
  report.invalid_pixels = fill_pyramid(tables_, input.depth, depth_);
  // A lens that is still covered says nothing of how far the scene goes.
  constexpr float kLeastReadings = 0.2f;
  const ImageView<float>& z = depth_.levels[0].z;
  const auto readings = static_cast<float>(z.pixels()) - static_cast<float>(report.invalid_pixels);
  if (course_ != Course::kWaiting || readings < kLeastReadings * static_cast<float>(z.pixels())) return;
  place_volume();
  course_ = Course::kFollowing;
}

// As wide as what the first frame with enough readings shows is far, and a little behind it; the camera
// stands before the middle of its near face.
void ScanTracker::place_volume() {
  constexpr float kBehind = 1.1f, kBeforeNearest = 0.05f;
  const float far_m = depth_quantile_m(depth_.levels[0].z, 0.95);
  const ScanPlace& place = config_.place;
  const float extent = place.extent_m > 0 ? static_cast<float>(place.extent_m)
                                          : std::clamp(kBehind * far_m, kMinExtent_m, kMaxExtent_m);
  Vec3f centre{0, 0, (0.5f - kBeforeNearest) * extent};
  if (place.has_centre)
    for (int a = 0; a < 3; ++a) centre[a] = static_cast<float>(place.centre_m[a]);
  const float voxel = extent / static_cast<float>(volume_.side - 1);
  volume_.reset(voxel, choose_truncation_m(voxel, depth_sigma_m(far_m)), centre);
}

// While searching, the scene is looked at from where the last try led to, else from the places that were most
// like what the camera sees now, one a frame, and from where it was lost.
void ScanTracker::predict() {
  T_world_view_ = course_ == Course::kSearching ? place_to_try() : motion_.predict(input_->device_t_s);
}

void ScanTracker::render(const LadderStep& step) {
  if (course_ == Course::kWaiting) return;  // the volume has no place yet
  const DepthPyramid::Level& level = depth_.levels[finest(step)];
  RaycastOptions options;
  options.with_color = false;
  options.smooth_young = true;
  // Where the camera is about where it is expected, its own readings say where the surfaces are.
  if (course_ != Course::kSearching) options.guess = level.z;
  raycast(volume_, level.camera, {0, 0, level.camera.width, level.camera.height}, T_world_view_.inverse(),
          raycast_scratch_, view_, options);
}

CameraPrior ScanTracker::prior() const {
  CameraPrior prior;
  if (course_ == Course::kSearching) prior.sigma_m = prior.sigma_rad = 0.3;
  prior.has_up = input_->has_gravity && norm(up_world_) > 0;
  if (prior.has_up) {
    prior.up_frame = normalized(input_->gravity_mps2);
    prior.up_view = T_world_view_.R.transposed() * normalized(up_world_);
  }
  return prior;
}

void ScanTracker::align(const LadderStep& step) {
  constexpr double kSearchGate_m = 0.3, kSecondGate_m = 0.2;
  aligned_ = CameraAlignResult{};
  verdict_ = CameraVerdict{};
  if (volume_.integrations == 0) return;
  CameraAlignInput in{depth_, view_, depth_.levels[finest(step)].camera, Pose{}, prior()};
  in.finest = finest(step);
  if (course_ == Course::kSearching) in.gate_m = kSearchGate_m;
  try_from(in);
  if (course_ == Course::kSearching || verdict_.state == TrackState::kGood) return;
  // A hand that stops or turns at once is nearer to where it was than to where it was going.
  in.start = T_world_view_.inverse() * motion_.last();
  in.gate_m = kSecondGate_m;
  try_from(in);
}

// Keeps what explains most pixels, and its verdict.
void ScanTracker::try_from(const CameraAlignInput& in) {
  const CameraAlignResult tried = align_camera(in);
  count_.pixels_aligned += static_cast<double>(tried.pixels_visited);
  if (aligned_.solved && tried.inliers <= aligned_.inliers) return;
  aligned_ = tried;
  verdict_ = judge_camera(tried, habit_);
}

void ScanTracker::judge() {
  camera_now_ = CameraSample{};
  if (course_ == Course::kWaiting) return;
  if (volume_.integrations == 0) {  // where the world begins
    camera_now_.state = TrackState::kGood;
    return;
  }
  camera_now_ = {verdict_.state, T_world_view_ * aligned_.T_view_camera, verdict_.explained,
                 static_cast<float>(aligned_.rms_m)};
  if (course_ == Course::kSearching && !found()) {
    follow_lead();
    camera_now_.state = TrackState::kLost;
  }
}

void ScanTracker::integrate(const LadderStep& step) {
  if (!step.integrate || camera_now_.state != TrackState::kGood || course_ != Course::kFollowing) return;
  EvidenceInput input;
  input.camera = camera_;
  input.roi = {0, 0, camera_.width, camera_.height};
  input.depth_m = depth_.levels[0].z;
  if (step.color_term && take_color()) input.color = color_;
  fused_ =
      st::integrate(volume_, input, camera_now_.T_world_camera.inverse(), kIntegrate, integrate_scratch_);
  count_.bricks_fused += fused_.bricks;
}

// False when this frame has no colour.
bool ScanTracker::take_color() {
  if (!calibration_.has_color || input_->color.empty()) return false;
  CameraMotion motion = motion_;
  motion.take(input_->device_t_s, camera_now_.T_world_camera);  // its way to here, not to where it was
  const Pose T_then_now = motion.moved_within(input_->color_device_t_s - input_->device_t_s).inverse();
  return frame_colors(calibration_, {input_->color}, to_float(T_then_now), depth_.levels[0].z, camera_,
                      color_);
}

void ScanTracker::decide() {
  switch (course_) {
    case Course::kWaiting:
      break;
    case Course::kFollowing:
      follow();
      break;
    case Course::kSearching:
      if (aligned_.readings > 0 && !has_lead_) ++tries_;  // a covered camera has not tried
      if (camera_now_.state != TrackState::kGood) break;
      motion_.restart(input_->device_t_s, camera_now_.T_world_camera);
      course_ = Course::kProving;
      proven_ = 0;
      camera_now_.state = TrackState::kPoor;
      break;
    case Course::kProving:
      prove();
      break;
  }
  const bool good = camera_now_.state == TrackState::kGood;
  ++(good ? count_.tracked : count_.lost);
  count_.good_at_end = good;
  if (good) last_good_t_s_ = input_->t_s;
}

void ScanTracker::follow() {
  constexpr int kMostPoor = 15;
  switch (camera_now_.state) {
    case TrackState::kGood:
      poor_run_ = 0;
      motion_.take(input_->device_t_s, camera_now_.T_world_camera);
      places_.remember(camera_now_.T_world_camera, depth_.levels[2].z);
      if (volume_.integrations > 1) learn(habit_, verdict_);
      learn_up();
      watch_border();
      return;
    case TrackState::kPoor:
      motion_.take(input_->device_t_s, camera_now_.T_world_camera);
      motion_.slow();
      if (++poor_run_ > kMostPoor) lose();
      return;
    default:
      lose();
  }
}

void ScanTracker::learn_up() {
  constexpr double kGravity_mps2 = 9.80665, kStill_mps2 = 0.6;
  if (!input_->has_gravity || std::fabs(norm(input_->gravity_mps2) - kGravity_mps2) > kStill_mps2) return;
  up_world_ += camera_now_.T_world_camera.R * normalized(input_->gravity_mps2);
}

// Said once each time that most of what the camera sees comes to lie outside of the volume.
void ScanTracker::watch_border() {
  constexpr float kOut = 0.6f, kBackIn = 0.4f;
  if (fused_.surface_pixels == 0) return;
  const float share = static_cast<float>(fused_.outside_pixels) / static_cast<float>(fused_.surface_pixels);
  if (!outside_ && share > kOut) log(EventKind::kVolumeLeft, static_cast<double>(share));
  outside_ = share > (outside_ ? kBackIn : kOut);
}

void ScanTracker::log(EventKind kind, double a, double b) {
  events_.push_back({input_->t_s, kind, 0, a, b, 0});
}

void ScanTracker::publish(FrameReport& report) {
  report.has_camera = true;
  report.camera = camera_now_;
  for (const Event& event : events_) report.events.push_back(event);
}

}  // namespace st
