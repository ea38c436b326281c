// Compares what a robot drove with the path that it was told to drive: where, not when. Every sample of the
// base is held against the place on the path that it has reached by then, so a late start or a slow wheel
// shows as little or as much as it puts the robot beside the path.
#pragma once

#include <span>

#include "algo/control/base_windows.hpp"
#include "algo/control/circle_fit.hpp"
#include "algo/control/path_sample.hpp"
#include "algo/core/pose.hpp"

namespace st {

inline constexpr double kPathBandM = 0.05;  // "in band": within this of the path

// A base sample beside the path.
struct PathError {
  double t_s = 0;          // the sample's
  double path_t_s = 0;     // the place on the path that it has reached
  double offset_m = 0;     // distance from the path, positive to its left
  double heading_rad = 0;  // base's yaw minus the path's
};

struct PathMeasure {
  Pose2 T_floor_path;  // where the path was laid
  double rmse_m = 0, max_m = 0, heading_rmse_rad = 0;
  double in_band = 0;  // share of the samples within kPathBandM
};

struct PathComparison {
  bool valid = false;                      // there was a path, and the base moved
  PathMeasure as_placed;                   // the path starts at the base's measured first pose
  PathMeasure shape;                       // the start pose is fitted out
  std::size_t first = 0, count = 0;        // the samples that count: from the start of motion to its end
  bool is_circle = false;                  // the path goes round one circle, at least half of it
  CircleFit preset_circle, driven_circle;  // on the floor; the preset one as placed
};

// The pose at which the base was first measured, its noise reduced: the mean while it stands, else the start
// of a line through the first third of a second. `base` is not empty.
Pose2 first_pose(std::span<const PlanarSample> base);

// `path` in the frame of its start. `base` on the floor. `placed` and `shaped` take the errors of each base
// sample that counts (base.size() is enough).
PathComparison compare_path(std::span<const PathSample> path, std::span<const PlanarSample> base,
                            std::span<PathError> placed, std::span<PathError> shaped,
                            std::span<Point2> scratch);

}  // namespace st
