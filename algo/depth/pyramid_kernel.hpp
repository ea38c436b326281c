// The vector part of fill_pyramid().
#pragma once

#include <cstdint>

namespace st {

// Half of the image, rounded down: the mean of those of four pixels that are not farther than one step of
// edge_step_m() from the nearest; 0 where all four are 0.
void halve_depth(const float* fine, int fine_width, float* coarse, int coarse_width, int coarse_height);

}  // namespace st
