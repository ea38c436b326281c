// The heading of what drives on wheels: expected from its motion, and defended against a picture that would
// turn it away.
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "algo/tracking/align_beside.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
void ObjectTracker::expect_heading(Track& track, AlignInput& in) const {
  track.heading = {};
  if (!in.floor.on || !in.terms.motion) return;
  const Pose2 predicted = support_.on_floor(in.prior.mean);
  track.heading = track.drive.expect(frame_.input->device_t_s, predicted);
  in.heading = {track.heading.known, wrap_angle(track.heading.yaw_rad - predicted.yaw),
                track.heading.sigma_rad};
}

void ObjectTracker::look_beside(Track& track, const AlignInput& in, std::size_t k) {
  // Of what something covers in part, that explains the residuals.
  if (!track.planar || owned_[k].divided) return;
  Mat3 turn;
  if (align_beside(in, track.habit, support_.up, scratch_, track.aligned, turn)) track.motion.turn(turn);
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
  const AlignResult expected = align_again(other, scratch_);
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
