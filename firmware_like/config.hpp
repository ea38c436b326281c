// What a run is told: the command line and --config FILE, checked before anything starts.
#pragma once

#include <cstdint>
#include <string>

#include "algo/recognition/recognition.hpp"

namespace st {

// The last two track by 3-D SIFT alone: matched with the database, or with the frame before.
enum class TrackerKind { kStar, kFrameToFrame, kListing1, kRecognition, kSiftMotion };

inline bool tracks_by_matches(TrackerKind kind) {
  return kind == TrackerKind::kRecognition || kind == TrackerKind::kSiftMotion;
}

struct LoopConfig {
  TrackerKind tracker = TrackerKind::kStar;
  int keyframe_every =
      0;  // frame-to-frame: 0 never, else a keyframe is kept for so many frames (calibration stage)
  int volume_side = 128;  // voxels a side of each object's volume
  bool use_contour = true, use_color = true, use_floor = true, use_motion = true;
  bool use_cleaning = true;  // pixels at steps in depth say nothing of a shape
  RecognitionWay recognition = RecognitionWay::kMatchesAndHeadings;
  double seconds = 0;  // stop after so much recorded (or live) time; 0: at the end
};

}  // namespace st
