// The vector part of Evidence::evaluate: plain arrays, see evidence.hpp for meanings.
#pragma once

#include <cstdint>

namespace st {

struct EvidenceKernel {
  const float* depth;  // at the rectangle's first pixel, kReach readable pixels (0: none) on every side
  int depth_stride;
  const std::uint8_t* owners;  // at the rectangle's first pixel, or null
  int owners_stride;
  std::uint8_t object, background;
  int width, height;     // of the rectangle
  float fx, fy, cx, cy;  // centre relative to the rectangle
  int wide;              // pixels to the outer pair that slopes are fitted to
  bool noise_aware;
  float sigma_floor, sigma_quadratic, nominal_sigma;
  float R[9], t[3];       // camera frame to object frame
  float low[3], high[3];  // the box, object frame
  int stride;
  float* z;
  std::uint32_t* meta;
  // Results.
  int surface = 0, refused = 0, outside = 0;
  float seen_low[3] = {1e9f, 1e9f, 1e9f}, seen_high[3] = {-1e9f, -1e9f, -1e9f};
};

void evaluate_pixels(EvidenceKernel& work);

// Per cell of 8 x 8 pixels: nearest and farthest surface sample, and the farthest pixel that empties its ray.
void reduce_cells(const float* z, const std::uint32_t* meta, int stride, int height, int cells_wide,
                  float* triples);

}  // namespace st
