// What 3-D SIFT looks at: a model's surface, bright where its print is bright (luminance times smoothed
// occupancy), as a cube of floats.
#pragma once

#include "algo/recognition/grid.hpp"
#include "algo/volume/volume.hpp"

namespace st {

inline constexpr int kAppearanceSide = 64;

// Voxel size for a thing of this extent (largest side), on a ladder of factors of sqrt(2) from 4 mm: two
// views of one thing are seen at the same size. Leaves a margin, so that the thing's outer surface is inside.
float appearance_voxel_m(float extent_m);

// Places the grid about `centre` (object frame).
void place_appearance(Grid& grid, float extent_m, const Vec3f& centre);

// Fills the slabs z0 <= z < z1. Occupancy is 1 on the surface and falls to 0 within 1.5 voxels on both sides;
// luminance is 0.3 ... 1, so that what is black has a shape, too; 0.65 where no colour is known.
void fill_appearance(const Volume& volume, const Grid& grid, int z0, int z1);

}  // namespace st
