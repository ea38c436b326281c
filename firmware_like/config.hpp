// What a run is told: the command line and --config FILE, checked before anything starts.
#pragma once

#include <cstdint>
#include <string>

#include "algo/recognition/recognition.hpp"

namespace st {

enum class TrackerKind { kStar, kFrameToFrame, kListing1 };

struct LoopConfig {
  TrackerKind tracker = TrackerKind::kStar;
  int keyframe_every =
      0;  // frame-to-frame: 0 never, else a keyframe is kept for so many frames (calibration stage)
  int volume_side = 128;  // voxels a side of each object's volume
  bool use_contour = true, use_color = true, use_floor = true, use_motion = true;
  RecognitionWay recognition = RecognitionWay::kMatchesAndHeadings;
  double seconds = 0;  // stop after so much recorded (or live) time; 0: at the end
};

}  // namespace st
