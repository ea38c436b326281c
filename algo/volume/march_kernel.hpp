// The vector part of raycast(): plain arrays, see raycast.hpp for meanings.
#pragma once

#include <cstdint>

namespace st {

inline constexpr int kRayTile = 8;     // pixels a side that share one depth range
inline constexpr int kRayMargin = 16;  // pixels around the padded depth image: as far as normals look

struct MarchKernel {
  // Volume, in units of voxels.
  int side;
  const std::int16_t* tsdf;
  const std::uint32_t* color;  // null: none is wanted
  const std::uint8_t* weight;
  float truncation_voxels;
  // Camera: a pixel's ray in voxels is eye + z * to_voxels * ((u - cx) / fx, (v - cy) / fy, 1).
  float eye[3], to_voxels[9];
  float fx, fy, per_fx, per_fy, cx, cy;
  int width, height, stride;
  const float* nearest;  // per tile; nearest > farthest: nothing there
  const float* farthest;
  const float* seed;  // guess of each pixel's depth, 0: none; or null
  int seed_stride;
  float seed_reach;  // metres of depth round the guess that a ray looks at
  float* depth;      // at the first pixel of the padded image
  int padded_stride, normal_reach;
  int young_reach;             // for surface of less than young_weight; 0: the same everywhere
  std::uint32_t young_weight;  // halves of a nominal observation
  float* z;
  std::uint32_t* normal;
  std::uint32_t* out_color;
  std::uint8_t* out_weight;
  // Results.
  int rays = 0, hits = 0;
};

void march_rays(MarchKernel& work);

}  // namespace st
