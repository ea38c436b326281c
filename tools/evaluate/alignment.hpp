// What turns one trajectory's frame into another's.
#pragma once

#include <span>
#include <vector>

#include "algo/core/pose.hpp"

namespace st {

// B with estimate[i] * B = truth[i] in the robust sense: geodesic median of the rotations, geometric median
// of the places.
Pose solve_offset(std::span<const Pose> estimate, std::span<const Pose> truth);

// T with truth = T * estimate over the positions, least squares (Umeyama); the scale is only reported.
struct Alignment {
  Pose T;
  double scale = 1;
};
Alignment align_positions(std::span<const Pose> estimate, std::span<const Pose> truth);

}  // namespace st
