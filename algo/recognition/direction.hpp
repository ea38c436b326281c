// The angle of a direction, fast: histograms of directions need it a million times, and no more than four
// digits of it.
#pragma once

#include <cmath>

namespace st {

// As arc_tan2(), to 2e-4 rad; the same bits everywhere. (0, 0): 0.
inline float coarse_arc_tan2(float y, float x) {
  const float ax = std::fabs(x), ay = std::fabs(y);
  const float large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
  if (!(large > 0)) return 0;
  // Hastings' polynomial for the arctangent on [0, 1].
  const float q = small / large, s = q * q;
  float a = q * (0.9998660f + s * (-0.3302995f + s * (0.1801410f + s * (-0.0851330f + s * 0.0208351f))));
  if (ay > ax) a = 1.57079633f - a;
  if (x < 0) a = 3.14159265f - a;
  return y < 0 ? -a : a;
}

}  // namespace st
