// The heading of what drives on wheels: expected from its motion, and defended against a picture that would
// turn it away.
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

constexpr float kBetter = 0.8f;  // of the residuals of a heading that is worth a change

// Colour and shape together, so that two alignments of one frame can be compared.
double look_score(const AlignResult& result) {
  if (!result.solved || result.depth.tried == 0) return 0;
  const double explained = static_cast<double>(result.depth.inliers) / result.depth.tried;
  const double sigma = result.color.sigma;
  return explained / (1.0 + sigma * sigma / 400.0);
}

}  // namespace

void ObjectTracker::expect_heading(Track& track, AlignInput& in) const {
  track.heading = {};
  if (!in.floor.on || !in.terms.motion) return;
  const Pose2 predicted = support_.on_floor(in.prior.mean);
  track.heading = track.drive.expect(frame_.input->device_t_s, predicted);
  in.heading = {track.heading.known, wrap_angle(track.heading.yaw_rad - predicted.yaw),
                track.heading.sigma_rad};
}

// A turn of several degrees in one frame, after frames that were dropped or when somebody nudges it, is
// beyond what colour leads back from: the print lies beside itself, and the alignment settles in between. The
// residuals of the colours tell; then headings beside the predicted one are tried, and the best look wins if
// it is as good as looks usually are.
void ObjectTracker::look_beside(Track& track, const AlignInput& in, std::size_t k) {
  constexpr double kStep_rad = 0.07;
  constexpr int kSteps = 3, kTryStride = 2;
  if (!track.aligned.solved || !track.planar || !track.habit.wondered_at_by_color(track.aligned)) return;
  if (owned_[k].divided) return;  // what covers a part of it explains the residuals
  AlignInput best = in;
  float least = kBetter * track.aligned.color.sigma;
  bool found = false;
  for (int i = -kSteps; i <= kSteps; ++i) {
    if (i == 0) continue;
    AlignInput other = in;
    other.prior.mean.R = rotation_from_vector(support_.up * (i * kStep_rad)) * in.prior.mean.R;
    other.start = other.prior.mean;
    other.heading.on = false;
    other.point_stride = kTryStride;
    const AlignResult tried = align(other, scratch_);
    if (!tried.solved || tried.color.used < kLeastColored || tried.color.sigma >= least) continue;
    least = tried.color.sigma;
    best = other;
    found = true;
  }
  if (!found) return;
  best.point_stride = in.point_stride;
  const AlignResult beside = align(best, scratch_);
  if (look_score(beside) <= look_score(track.aligned) || track.habit.wondered_at_by_color(beside)) return;
  track.motion.turn(best.prior.mean.R * in.prior.mean.R.transposed());
  track.aligned = beside;
}

// A model that has followed a small error drifts with it, frame after frame, and every frame agrees. The
// motion knows better: when the pose has turned away from it, the frame is aligned once more from the
// expected heading, and the better look wins. While the doubt lasts nothing enters the model.
void ObjectTracker::defend_heading(Track& track, const AlignInput& in) {
  track.heading_doubt = false;
  if (!in.heading.on || !track.aligned.solved) return;
  constexpr double kDoubt_rad = 0.1, kSigmas = 2.5, kAsGood = 0.97;
  const double off = wrap_angle(support_.on_floor(track.aligned.T_camera_object).yaw - track.heading.yaw_rad);
  const double least = kSigmas * track.heading.sigma_rad;
  if (std::fabs(off) < (least > kDoubt_rad ? least : kDoubt_rad)) return;
  track.heading_doubt = true;
  AlignInput other = in;
  const Mat3 turn = rotation_from_vector(support_.up * in.heading.turn_rad);
  other.prior.mean.R = turn * in.prior.mean.R;
  other.start = other.prior.mean;
  other.heading.turn_rad = 0;
  const AlignResult expected = align(other, scratch_);
  const double still_off =
      wrap_angle(support_.on_floor(expected.T_camera_object).yaw - track.heading.yaw_rad);
  const bool agrees = std::fabs(still_off) < 0.5 * std::fabs(off);
  if (!agrees || look_score(expected) < kAsGood * look_score(track.aligned)) return;
  track.drive.turn_recent(-off);
  track.motion.turn(turn);
  track.motion.set_turn_rate(track.heading.rate_rps);
  track.aligned = expected;
}

}  // namespace st
