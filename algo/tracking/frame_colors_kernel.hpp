// The vector part of frame_colors(): plain arrays.
#pragma once

#include <cstdint>

namespace st {

struct FrameColorsKernel {
  const float* z;  // depth image, metres, 0: none
  int width, height;
  float cx, cy, per_fx, per_fy;
  float R[9], t[3];  // depth camera to colour camera
  const std::uint8_t* rgb;
  int color_width, color_height;
  float color_fx, color_fy, color_cx, color_cy;
  bool distorted;
  float k[5];          // Brown-Conrady k1 k2 p1 p2 k3, see distort(); read when distorted
  std::uint32_t* out;  // width x height
};

void sample_colors(const FrameColorsKernel& work);

}  // namespace st
