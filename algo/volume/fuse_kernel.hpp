// The vector part of integrate(): the voxels of listed bricks look their pixel up and are updated. Plain
// arrays.
#pragma once

#include <cstddef>
#include <cstdint>

namespace st {

struct FuseBrick {
  std::uint16_t x, y, z;
  bool carve;           // what is seen to be empty may be emptied here
  float near_m, far_m;  // depths outside of which no surface sample changes anything in the brick
};

struct FuseKernel {
  // Volume.
  int side;
  std::int16_t* tsdf;
  std::uint8_t* weight;
  std::uint8_t* observations;
  std::uint32_t* color;
  std::uint8_t* bricks;
  std::uint8_t* octants;
  const FuseBrick* list;
  std::size_t listed;
  // Camera position (metres) of voxel (0, 0, 0), and the steps to the next voxel along x, y and z.
  float first[3], step_x[3], step_y[3], step_z[3];
  // Pixels: (u, v) relative to the evidence's rectangle, centres at whole numbers.
  float fx, fy, cx, cy, per_fx, per_fy;
  int width, height, stride;
  const float* z;
  const std::uint32_t* meta;
  const std::uint32_t* pixel_color;  // at the rectangle's first pixel, or null
  int color_stride;
  // Rules.
  float per_truncation, reach;  // 1/m; metres before and behind a pixel within which a voxel may be updated
  float cap, carve_weight;      // nominal observations
  float color_band;             // of the truncation: voxels this near to the surface have its colour
  float dither[3];              // in [0, 1): unbiased rounding of the byte means
  float color_cap;
  // Results.
  int updated = 0, carved = 0, colored = 0, color_refused = 0;
};

void fuse_bricks(FuseKernel& work);

}  // namespace st
