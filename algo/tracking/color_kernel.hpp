// The vector part of the colour term: plain arrays, see color_term.hpp for meanings.
#pragma once

#include "algo/tracking/pairing.hpp"

namespace st {

struct ColorKernel {
  Pairing pairing;
  float gate_m;
  float gain, offset, shift_u, shift_v;
  float least_gradient2;
  float per_cut2;  // 1 / (residual at which the weight reaches zero)^2
  float weight;    // of a point whose residual is nought
  // Results, added to.
  double triangle[36]{}, gradient[8]{};
  int used = 0;
};

void accumulate_color(ColorKernel& work);

// The model's luminance where each point falls, shift included; negative where there is none. `out` holds
// pairing.count values, and PointTable::kPadding more that may be overwritten.
void sample_luminance(const ColorKernel& work, float* out);

}  // namespace st
