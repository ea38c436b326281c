// Whether an object rests on the floor. While it does it stays in the floor's plane; a tilted or lifted one
// has six degrees of freedom.
#include <cmath>

#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

constexpr double kRestHeight_m = 0.012, kRestLean_rad = 0.03;

bool is_off(const Pose& T_camera_object, const Support& support) {
  return std::fabs(support.height_of(T_camera_object.t)) > kRestHeight_m ||
         norm(T_camera_object.R.col(2) - support.up) > kRestLean_rad;
}

}  // namespace

// The floor prior is stiff enough to hold a tilted object upright against its own pixels, which then fit
// badly. Only in such a frame is the object aligned once more without the floor; when frame after frame
// explains far more pixels that way, it has left the floor.
void ObjectTracker::leave_floor(Track& track, const AlignInput& held) {
  constexpr int kLeaves = 3;
  constexpr double kDoubtful = 0.8, kBetter = 1.1;
  const DepthTermResult& fit = track.aligned.depth;
  if (!track.aligned.solved || fit.inliers > kDoubtful * fit.tried) {
    track.off_floor_run = 0;
    return;
  }
  AlignInput in = held;
  MotionFilter motion = track.motion;
  motion.leave_plane();
  in.prior = motion.prior();
  in.start = track.aligned.T_camera_object;
  in.floor.on = false;
  const AlignResult free = align_again(in, scratch_);
  const bool off =
      free.solved && free.depth.inliers > kBetter * fit.inliers && is_off(free.T_camera_object, support_);
  track.off_floor_run = off ? track.off_floor_run + 1 : 0;
  if (track.off_floor_run < kLeaves) return;
  track.off_floor_run = 0;
  track.planar = false;
  track.motion = motion;
  track.aligned = free;
}

void ObjectTracker::return_to_floor(Track& track) {
  constexpr int kRests = 30;
  track.on_floor_run =
      support_.found && !is_off(track.aligned.T_camera_object, support_) ? track.on_floor_run + 1 : 0;
  if (track.on_floor_run < kRests) return;
  track.on_floor_run = 0;
  track.planar = true;
}

}  // namespace st
