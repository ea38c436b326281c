// The vector part of the colour term: plain arrays, see color_term.hpp for meanings.
#pragma once

#include "algo/tracking/color_frame.hpp"

namespace st {

struct ColorKernel {
  const float *x, *y, *z, *luminance;  // the model's points, in the camera frame of its view
  int count;
  const ColorPixel* frame;  // record 0 is empty, then width x height
  int width, height;
  float fx, fy, cx, cy;            // of the colour camera; cx, cy from the rectangle's first pixel
  float to_then[9], then_at[3];    // p in the depth camera's frame when the colour image was taken
  float to_color[9], color_at[3];  // and from there to the colour camera's
  float pivot[3];                  // depth camera's frame, then
  float gain, offset, shift_u, shift_v;
  float least_gradient2;
  float per_cut2;  // 1 / (residual at which the weight reaches zero)^2
  float weight;    // of a point whose residual is nought
  // Results, added to.
  double triangle[36]{}, gradient[8]{};
  int used = 0;
};

void accumulate_color(ColorKernel& work);

// The image's luminance where each point falls, shift included; negative where there is none. `out` holds
// `count` values, and PointTable::kPadding more that may be overwritten.
void sample_luminance(const ColorKernel& work, float* out);

}  // namespace st
