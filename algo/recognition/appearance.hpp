// What 3-D SIFT looks at: a model as a cube of floats, luminance times smoothed occupancy. A surface alone is
// a sheet thinner than the smallest scale, and has no extremum across scales; so what stands on the floor is
// taken for solid from its topmost surface down, and the print of that surface goes down with it.
#pragma once

#include "algo/recognition/grid.hpp"
#include "algo/tracking/track.hpp"
#include "algo/volume/volume.hpp"

namespace st {

inline constexpr int kAppearanceSide = 64;

struct Appearance {
  float floor_z_m = 0;         // object frame: where the solid ends below
  float least_top_m = 0;       // a topmost surface below is floor that hangs on to it
  float mean_luminance = 128;  // of the whole surface, 0-255: what is as bright becomes 0.5 in any light
};

// Voxel size for a thing of this extent (largest side), on a ladder of factors of sqrt(2) from 4 mm: two
// views of one thing are seen at the same size. Leaves a margin, so that the thing's outer surface is inside.
float appearance_voxel_m(float extent_m);

// Places the grid about the middle of the box (object frame).
void place_appearance(Grid& grid, const Bounds& bounds);

// Fills the columns y0 <= y < y1 of the grid. Values are 0 (nothing there), 0.15 (black) to 1.
void fill_appearance(const Volume& volume, const Appearance& how, const Grid& grid, int y0, int y1);

}  // namespace st
