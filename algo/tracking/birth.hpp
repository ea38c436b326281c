// The first frame of an unknown object becomes its model (STAR, section 4.2): where its frame lies, how fine
// its volume is.
#pragma once

#include <span>

#include "algo/tracking/track.hpp"

namespace st {

struct Footprint {
  Pose T_camera_object;   // origin at the footprint's centre on the floor, axes parallel to the floor's
  Bounds bounds;          // object frame, without the outermost percent on each side
  bool on_floor = false;  // reaches down to the floor
};

// Where the points stand. Without a floor the origin lies at the points' lowest level.
Footprint find_footprint(std::span<const ObservedPoint> points, const Support& support);

// Least extent that a model's box covers, and how much wider than the first view it is made: what is not seen
// yet needs room too.
inline constexpr double kLeastBox_m = 0.48, kBoxGrowth = 1.7;

// Starts the track: empty volume around the footprint, motion at rest. The model itself is integrated by the
// caller.
void start_track(Track& track, const Footprint& footprint, const Support& support, double t_s);

}  // namespace st
