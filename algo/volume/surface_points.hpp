// The model as a cloud of points (STAR, Listing 1, line 7): where the distance changes its sign between a
// voxel and a neighbour, there is a point of the surface.
#pragma once

#include <cstddef>
#include <span>

#include "algo/volume/volume.hpp"

namespace st {

// Writes surface points (object frame, metres), in memory order of the voxels, and returns how many. When
// there are more than `out` holds, every second, third, ... is taken.
std::size_t surface_points(const Volume& volume, std::span<Vec3f> out);

}  // namespace st
