#include "firmware_like/scan_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace st {
namespace {

constexpr int kScanSide = 256;
// A room does not change: what was seen often is to be held as long as a byte can count.
constexpr IntegrateOptions kIntegrate{.noise = {}, .weight_cap = kMaxWeightCap};
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
  plan.add("depth images of the frame", "algo/depth", parts_[0]);
  plan.add("the scene, one volume", "algo/volume", parts_[1]);
  plan.add("view of the scene", "algo/volume", parts_[2]);
  plan.add("work memory of the fusion", "algo/volume", parts_[3]);
}

void ScanTracker::bind_images(Bump& memory) {
  tables_.bind(memory, calibration_);
  depth_.bind(memory, camera_);
}

void ScanTracker::bind_volume(Bump& memory) { volume_.bind(memory, config_.volume_side); }

void ScanTracker::bind_view(Bump& memory) {
  view_.bind(memory, camera_.width, camera_.height);
  raycast_scratch_.bind(memory, camera_.width, camera_.height);
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
  if (frames_++ == 0) place_volume();
}

// As wide as what the first frame shows is far, and a little behind it; the camera stands before the middle
// of its near face.
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

void ScanTracker::predict() { T_world_view_ = motion_.predict(input_->device_t_s); }

void ScanTracker::render() {
  raycast(volume_, camera_, {0, 0, camera_.width, camera_.height}, T_world_view_.inverse(), raycast_scratch_,
          view_, {false, true});
}

void ScanTracker::align() {
  aligned_ = CameraAlignResult{};
  if (volume_.integrations == 0) return;
  aligned_ = align_camera({depth_, view_, camera_, Pose{}, {}});
}

void ScanTracker::judge() {
  constexpr double kMostMove_m = 0.3, kMostTurn_rad = 0.4;
  constexpr float kLeastExplained = 0.4f, kLeastPaired = 0.08f;
  camera_now_ = CameraSample{};
  if (volume_.integrations == 0) {  // the first frame is where the world begins
    const bool usable = static_cast<int>(depth_.levels[0].z.pixels()) > 0;
    camera_now_.state = usable ? TrackState::kGood : TrackState::kLost;
    return;
  }
  const Pose& T = aligned_.T_view_camera;
  camera_now_.T_world_camera = T_world_view_ * T;
  camera_now_.residual_m = static_cast<float>(aligned_.rms_m);
  if (aligned_.paired > 0)
    camera_now_.inliers = static_cast<float>(aligned_.inliers) / static_cast<float>(aligned_.paired);
  const float paired = static_cast<float>(aligned_.paired) / static_cast<float>(depth_.levels[0].z.pixels());
  const bool plausible = norm(T.t) < kMostMove_m && rotation_angle(T.R) < kMostTurn_rad;
  const bool good =
      aligned_.solved && plausible && paired > kLeastPaired && camera_now_.inliers > kLeastExplained;
  camera_now_.state = good ? TrackState::kGood : TrackState::kLost;
}

void ScanTracker::integrate() {
  if (camera_now_.state != TrackState::kGood) return;
  EvidenceInput input;
  input.camera = camera_;
  input.roi = {0, 0, camera_.width, camera_.height};
  input.depth_m = depth_.levels[0].z;
  fused_ =
      st::integrate(volume_, input, camera_now_.T_world_camera.inverse(), kIntegrate, integrate_scratch_);
}

void ScanTracker::decide() {
  if (camera_now_.state == TrackState::kGood) {
    motion_.take(input_->device_t_s, camera_now_.T_world_camera);
    frames_lost_ = 0;
    ++count_.tracked;
  } else {
    motion_.stop();
    ++frames_lost_;
    ++count_.lost;
  }
  count_.good_at_end = camera_now_.state == TrackState::kGood;
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
