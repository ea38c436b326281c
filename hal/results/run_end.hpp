// What the loop knows when it ends and the result files need: the part of summary.json that no frame carries.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algo/core/mesh.hpp"
#include "algo/core/records.hpp"

namespace st {

struct ObjectEnd {
  int id = 0;
  std::string name;  // empty: "object-N"
  bool model_from_database = false;
  std::string model_id;
  double first_t_s = 0, last_t_s = 0;   // first and last row of its .tum
  std::uint64_t tracked = 0, lost = 0;  // as the contract counts them
  double iterations_mean = 0;           // of the alignment, over the frames that had one
  bool good_at_end = false;
  bool left_view = false;
  Pose T_model_object{};
  MeshView mesh;  // object frame; empty when the mesh was skipped
};

// The hand-held camera of scan mode, and what it saw.
struct CameraEnd {
  std::uint64_t tracked = 0, lost = 0;  // frames with a row in camera.tum, and without
  bool good_at_end = false;
  double pixels_aligned = 0, bricks_fused = 0;  // sums over all frames: what the work was
  MeshView scene;                               // world frame; empty when the mesh was skipped
};

// Trackers that take their poses from 3-D SIFT matches: frames with a segment, and at which stage those
// without a pose failed.
struct MatchingEnd {
  std::uint64_t frames = 0, found = 0, no_keypoints = 0, no_matches = 0, no_agreement = 0, not_verified = 0;
};

struct RunInfo {  // known at the start
  std::string version, source, mode, tracker, simd;
  std::string path_file;  // empty: no path
  bool live = false;
};

enum class Ending { kDone, kInterrupted, kFault, kDiskFull };
const char* name_of(Ending ending);

struct RunEnd {
  RunInfo info;
  std::uint64_t frames = 0;
  Ending ending = Ending::kDone;
  int signal = 0;       // kInterrupted: which one
  double last_t_s = 0;  // stamp of the last frame
  bool floor_found = false;
  bool has_floor_frame = false;
  Pose T_floor_camera{};
  std::vector<ObjectEnd> objects;
  bool has_camera = false;  // scan mode
  CameraEnd camera;
  std::optional<MatchingEnd> matching;
  // The object that is the robot: picked as the one that obeys, or else that went along with the wheels; 0:
  // none.
  int steering_object = 0;
  double path_begins_t_s =
      -1;  // what was driven before was the start motion; -1: the path began with the drive
  std::uint64_t planned_bytes = 0, peak_rss_bytes = 0, heap_calls_after_seal = 0, page_faults_after_seal = 0;
  std::uint64_t deadline_misses = 0;
};

// What is learned from the whole run once it has ended (firmware_like/run_analysis.hpp fills it).
struct BaseEnd {
  double x_m = 0, y_m = 0, yaw_rad = 0;  // base in the object's frame: turning centre, forward direction
  double sigma_m = 0, sigma_rad = 0;
  std::vector<std::array<double, 4>> rows;  // t,x,y,yaw in the floor frame
};

struct ObjectAnalysis {
  int id = 0;
  double path_length_m = 0;
  bool has_base = false;  // moved like a differential-drive robot
  BaseEnd base;
};

struct PathEnd {
  double rmse_as_placed_m = 0, rmse_shape_m = 0, max_m = 0, heading_rmse_rad = 0, in_band = 0;
  bool is_circle = false;
  double radius_m = 0;                      // of what was driven, when the preset path is a circle
  std::vector<std::array<double, 6>> rows;  // the preset path on the floor: t,x,y,yaw,v,w
};

struct RunAnalysis {
  std::vector<ObjectAnalysis> objects;
  bool has_path = false;  // a path was given and something drove it
  PathEnd path;
};

}  // namespace st
