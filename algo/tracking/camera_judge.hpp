// Whether a hand-held camera's pose may be believed: a frame that is fused at a wrong pose spoils the scene
// for good.
#pragma once

#include "algo/core/records.hpp"
#include "algo/tracking/camera_align.hpp"

namespace st {

struct CameraVerdict {
  TrackState state = TrackState::kLost;  // good, poor (not to be fused, but followed) or lost
  float explained = 0;  // of the pixels that face a surface of the scene, the share within three sigma of it
  float paired = 0;     // share of the image's pixels with a surface of the scene in reach
  double least_seen_m = 0;  // one sigma in the direction that the depth says least about
};

struct CameraHabit {
  float explained = 0;  // running mean over good frames; 0: none yet
};

// The step from the prediction counts as well: a hand does not jump.
CameraVerdict judge_camera(const CameraAlignResult& result, const CameraHabit& habit);

void learn(CameraHabit& habit, const CameraVerdict& verdict);

}  // namespace st
