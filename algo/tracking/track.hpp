// One object being tracked: its model, its motion, and how sure we are of it.
#pragma once

#include "algo/core/records.hpp"
#include "algo/tracking/align.hpp"
#include "algo/tracking/drive_model.hpp"
#include "algo/tracking/judge.hpp"
#include "algo/tracking/model_view.hpp"
#include "algo/tracking/motion_filter.hpp"
#include "algo/tracking/wheel_witness.hpp"
#include "algo/volume/volume.hpp"

namespace st {

// The floor, or what stands in for it, in the camera frame: decides how object frames lie.
struct Support {
  bool found = false;     // false: up is gravity's, or the camera's own
  Vec3 up{0, -1, 0};      // unit, camera frame
  double d = 0;           // up . p + d = 0 on the floor; 0 when not found
  Mat3 R_camera_floor{};  // columns: x (the camera's axis laid on the floor), y, z = up

  double height_of(const Vec3& p) const { return dot(up, p) + d; }
  // Place and heading along the floor's axes, which begin at the camera.
  Pose2 on_floor(const Pose& T_camera_object) const;
};
Support make_support(const Vec3& up, double d, bool found);

// Box in the object's frame around what has been seen of it.
struct Bounds {
  Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};

  bool empty() const { return low.x > high.x; }
  void include(const Vec3& p) {
    for (int i = 0; i < 3; ++i) {
      if (p[i] < low[i]) low[i] = p[i];
      if (p[i] > high[i]) high[i] = p[i];
    }
  }
  bool contains(const Vec3& p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
  }
  Vec3 centre() const { return (low + high) * 0.5; }
  Vec3 size() const { return high - low; }
};

// From which sides an object has been seen, as seen from itself: 10 degrees of azimuth, 30 of elevation. A
// side that was fused often enough is left alone: fusing for ever would let the model follow every small
// error of its own tracking.
struct SeenSides {
  static constexpr int kAzimuths = 36, kElevations = 6;
  std::uint8_t fused[kAzimuths * kElevations]{};

  std::uint8_t& side_of(const Pose& T_camera_object);
};

struct Track {
  // Candidate: has a model, not yet three good poses. Lost: keeps model and number, waits to be found again.
  enum class Phase : std::uint8_t { kFree, kCandidate, kTracked, kLost };

  Phase phase = Phase::kFree;
  int id = 0;              // 0 until confirmed
  bool left_view = false;  // went out through the edge of the image
  bool from_background = false;
  int owned_pixels = 0;  // in the last frame in which it had any
  int divided_run = 0;   // frames in a row in which something hung together with it
  int cut_balance = 0;   // frames in which the view's edge may have cut it, less those in which it did not
  Volume volume;
  Bounds bounds;
  MotionFilter motion;
  DriveModel drive;
  ExpectedHeading heading;     // in this frame, from its motion
  bool heading_doubt = false;  // what it looks like contradicts that
  WheelWitness wheels;         // whether the robot's wheels may tell its turn
  bool asked_wheels = false;   // and whether they did in this frame
  Pose T_camera_object;        // newest estimate, whatever its state
  Pose T_last_good;
  TrackState state = TrackState::kLost;

  Pose T_birth;  // camera frame
  bool has_moved = false;
  int good_poses = 0;  // since birth
  int poor_run = 0;    // frames in a row without a good pose
  SeenSides sides;
  int integrated = 0;      // frames fused into the model
  bool told_full = false;  // that its volume is too small
  int still_run = 0;       // frames in a row without motion
  int double_run = 0;      // frames in a row in which its model lay inside another's
  int lost_run = 0;        // frames in a row in which it was lost
  int published_gap = 0;   // predicted rows in a row
  double last_good_t_s = 0;
  double yaw_unwrapped = 0;  // as published, floor frame

  // Recognised: its pose and model are those of a stored model's frame, in which its own frame lies there.
  int named_model = -1;  // of the database: what it is, though perhaps not which way round; -1: new
  int known_model = -1;  // of the database, its heading known; -1: none
  Pose T_model_object{};
  int look_ups = 0;      // how often it was compared with the database
  bool matched = false;  // recognition tracker: this frame's pose was found

  bool planar = true;     // rests on the floor: floor prior applies
  int off_floor_run = 0;  // frames in a row that contradict it
  int on_floor_run = 0;   // frames in a row that would allow it again

  ModelView rendered;  // memory for the model's view
  ModelView view;  // what this frame is aligned with: rendered, or in frame-to-frame mode the frame before
  int view_pixels = 0;  // with a surface
  std::size_t points_used = 0;
  AlignResult aligned;
  Agreement agreement;
  Verdict verdict = Verdict::kLost;
  Habit habit;
  YawSource yaw_source = YawSource::kNone;

  // What is seen may be a part of something larger. A whole thing that an arm takes hold of stays whole.
  bool cut() const { return cut_balance > 0; }
  bool active() const { return phase == Phase::kCandidate || phase == Phase::kTracked; }
};

}  // namespace st
