// What a run is told: the command line and --config FILE, checked before anything starts.
#pragma once

#include <cstdint>
#include <string>

#include "algo/core/fixed_vector.hpp"
#include "algo/core/polygon.hpp"
#include "algo/recognition/recognition.hpp"

namespace st {

// The last two track by 3-D SIFT alone: matched with the database, or with the frame before.
enum class TrackerKind { kStar, kFrameToFrame, kListing1, kRecognition, kSiftMotion };

inline bool tracks_by_matches(TrackerKind kind) {
  return kind == TrackerKind::kRecognition || kind == TrackerKind::kSiftMotion;
}

enum class Mode { kObject, kScan };

// Where the cube of scan mode lies. Metres, in the world frame, which is the camera's first pose (x right, y
// down, z forward).
struct ScanPlace {
  double extent_m = 0;  // side of the cube; 0: from what the first frame shows
  bool has_centre = false;
  double centre_m[3] = {0, 0, 0};
};

struct LoopConfig {
  Mode mode = Mode::kObject;
  TrackerKind tracker = TrackerKind::kStar;
  int keyframe_every =
      0;  // frame-to-frame: 0 never, else a keyframe is kept for so many frames (calibration stage)
  int volume_side = 0;  // voxels a side of each volume; 0: 128 for an object, 256 for a scene
  ScanPlace place;      // scan mode
  // No track starts outside; empty: anywhere. On the floor, from the point below the camera: x along its axis
  // laid on the floor, y to the left.
  FixedVector<PlanePoint, 16> arena;
  bool use_contour = true, use_color = true, use_floor = true, use_motion = true, use_wheels = true;
  bool use_cleaning = true;  // pixels at steps in depth say nothing of a shape
  RecognitionWay recognition = RecognitionWay::kMatchesAndHeadings;
  double camera_lag_s = 0;  // the camera's delay beyond that of the wheels' reports (calibrated)
  double seconds = 0;       // stop after so much recorded (or live) time; 0: at the end
};

}  // namespace st
