// Trajectories in TUM's text format: `timestamp tx ty tz qx qy qz qw`, '#' comments; a ninth field names a
// track.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "algo/core/pose.hpp"

namespace st {

struct TumPose {
  double t_s = 0;
  Pose T;
  std::string track = "0";
};

struct TumTrajectory {
  std::vector<TumPose> poses;     // by time
  std::size_t dropped_lines = 0;  // no numbers, not finite, or a quaternion of length zero
};

// Spaces or commas between the fields. Bad lines are dropped and counted, a last line without its end
// included only when it is complete. Never fails.
TumTrajectory parse_tum(std::string_view text);

}  // namespace st
