// Finds the base of a differential-drive robot in the frame of a tracked object: its turning centre on the
// floor and the direction in which it drives. Nobody tells the tracker where the wheels are; the motion does.
//
// The wheels do not slip sideways, so a point on the axle moves along the heading only. With a(t) = (ax, ay,
// s) the integral of the object's motion in its own axes (travel forward, travel to the left, angle turned),
// a base at b = c f + l n, with f = (cos phi, sin phi) the forward direction and n to its left, sees
//     lateral motion  -sin(phi) ax + cos(phi) ay + c s = 0      always
//     forward motion   cos(phi) ax + sin(phi) ay - l s = 0      while it turns on the spot
// These integrals are exact for any motion that is an arc between two samples, and the noise of a sample
// enters each of them once. Over a window of the run each must therefore be constant, up to that noise: the
// scatter of `a` over the window is all that the fit needs.
//
// What the motion cannot tell: where on the axle the centre is (l) without a turn on the spot, c without any
// turn, and on a circle at constant speed only one combination of phi and c. There the shape decides
// (BasePrior); sigmas say what is left.
#pragma once

#include <span>

#include "algo/control/base_windows.hpp"

namespace st {

// What the shape says about the turning centre (algo/control/footprint.hpp), in the object's frame.
struct BasePrior {
  double x_m = 0, y_m = 0;
  double sigma_forward_m = 0.05;  // along the driving direction
  double sigma_lateral_m = 0.05;  // across it
};

struct BaseEstimate {
  bool observed = false;            // moved enough to tell a direction: the rest is meaningful
  bool differential_drive = false;  // observed, and nearly all of the motion was along it
  double x_m = 0, y_m = 0;          // turning centre in the object's frame
  double yaw_rad = 0;               // forward direction in the object's frame, (-pi, pi]
  double sigma_m = 0, sigma_rad = 0;
  double lateral_rms_m = 0;  // motion across the heading that stays unexplained, over windows of half a metre
  double travel_m = 0, turn_rad = 0, spot_turn_rad = 0;  // the motion that the estimate rests on
};

inline constexpr std::size_t kBaseWindows = 512;  // 256 m of driving; what comes later adds nothing

// Uses as many windows as fit into `windows` (kBaseWindows are plenty).
BaseEstimate estimate_base(std::span<const PlanarSample> samples, const BasePrior& prior,
                           std::span<BaseWindow> windows);

}  // namespace st
