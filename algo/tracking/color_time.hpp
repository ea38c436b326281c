// The colour image is older than the depth image by up to a frame. What it shows of the object is the pose at
// its own time, which is tied to the pose sought by the motion between the two. Registering with estimated
// rates instead would feed those rates back into the pose that they are learned from, and the heading would
// swing.
#pragma once

#include "algo/tracking/pose_tie.hpp"

namespace st {

struct ColorTime {
  Pose motion;  // predicted: p(then) = motion * p(now), camera frame
  PoseTie tie;  // of deviations from the predicted poses
};

// The likely pose then if it is T now. `mean` is the predicted pose now; deviations are motions about `pivot`
// (camera frame), which then is at motion * pivot. `rest`: what the colour image said of it, if it did yet.
inline Pose pose_then(const ColorTime& time, const Pose& mean, const Pose& T, const Vec3& pivot,
                      const TieRest& rest = {}) {
  const Twist now{T * (mean.inverse() * pivot) - pivot, rotation_to_vector(T.R * mean.R.transposed())};
  return moved_about(time.motion * mean, tied_deviation(time.tie, now, rest.mean), time.motion * pivot);
}

}  // namespace st
