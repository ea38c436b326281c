// The one rule of where a depth image passes from one surface to another.
#pragma once

namespace st {

// A step in depth, metres, between pixels at most two apart: above what noise and slopes up to about 75
// degrees make. Kernels take the two numbers for their vectors.
inline constexpr float kEdgeStep_m = 0.015f, kEdgeStepPerSquare_per_m = 0.012f;
constexpr float edge_step_m(float z_m) { return kEdgeStep_m + kEdgeStepPerSquare_per_m * z_m * z_m; }

}  // namespace st
