// The robot's wheels, from where it was seen to drive and what its wheels reported meanwhile. Over a stretch
// in which the wheels reported L and R and the base went d forward and turned by a,
//     a = (s_R R - s_L L) / b        d = (s_R R + s_L L) / 2
// with s_L, s_R the true sizes beside the believed ones and b the true base. The turns give s_R / b and s_L /
// b by least squares, the ways then b: what UMBmark (Borenstein and Feng 1996) gets from where a square ends,
// taken from all of the way. The camera's lag is the one under which both fit best.
#pragma once

#include <span>

#include "algo/control/base_windows.hpp"

namespace st {

// What the wheels had rolled by a time, since some time before.
struct WheelMark {
  double t_s = 0, left_m = 0, right_m = 0;
};

struct WheelFit {
  bool valid = false;  // turned both ways or drove straight and turned: everything is known
  double left_scale = 1, right_scale = 1, wheel_base_m = 0;
  double lag_s = 0;  // the camera's stamps are later than the wheels' by so much
  double sigma_scale = 0, sigma_base_m = 0;
  double misfit_rad = 0;           // RMS of the turns of stretches of half a second
  double way_m = 0, turn_rad = 0;  // that it rests on
};

inline constexpr std::size_t kFitWindows = 4096;
struct FitWindow {
  double left_m = 0, right_m = 0, forward_m = 0, turn_rad = 0;
  bool used = false;
};

// `base` (floor frame) and `marks` in order of time, on one clock. `memory`: kFitWindows are plenty.
WheelFit fit_wheels(std::span<const PlanarSample> base, std::span<const WheelMark> marks,
                    std::span<FitWindow> memory);

}  // namespace st
