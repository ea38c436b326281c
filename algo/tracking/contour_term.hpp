// Where the object ends against what lies behind it: each outline pixel of the model view looks along its
// outward normal for the place where the present frame steps from the object to something farther (RAPID,
// Harris 1990; region-based trackers use the same search lines). Holds a flat, round object sideways, where
// its few side pixels say little. It says nothing about the turn: ragged edges pull normals off the true
// ones, and a round outline then holds on to the old heading.
#pragma once

#include <span>

#include "algo/tracking/normal_equations.hpp"
#include "algo/tracking/view_table.hpp"

namespace st {

struct OutlinePoint {
  Vec3f p;               // model surface at the outline, in the view's camera frame, metres
  float nu = 0, nv = 0;  // unit outward normal in the image
};

// A point of the outline and what was found on its search line.
struct ContourPoint {
  OutlinePoint outline;
  float edge_px =
      0;  // where the present frame's edge lies along the normal, from the image's centre (cx, cy)
  float sigma_px = 0;  // wider where the step lies in a hole of the depth image
};

struct ContourTermOptions {
  int reach_px = 12;
  float inside_gate_m = 0.06f;  // present depth this near to the model's is still the object
  float behind_m =
      0.04f;  // and this far behind it is not: the line where an object meets the floor is no edge
  float correlated_pixels = 30.0f;
  float robust_px = 4.0f;
};

inline constexpr std::size_t kMaxContourPoints = 1024;

// The outline of the view: the same for every pose that it is compared at. Returns how many points of `out`
// were filled; a longer outline is thinned evenly.
std::size_t find_outline(const ViewTable& view, const Pinhole& camera, std::span<OutlinePoint> out);

// Finds the edges, searched about the pose D * view.T_camera_object. depth_z: the frame's depth in metres, 0
// = none. Returns how many points of `out`, which is as long as `outline`, were filled.
std::size_t find_contour(std::span<const OutlinePoint> outline, const Pinhole& camera,
                         ImageView<const float> depth_z, const Pose& D, const ContourTermOptions& options,
                         std::span<ContourPoint> out);

// Adds the term at the pose D * view.T_camera_object; the edges' common offset (the sensor fattens or thins
// every edge alike) is taken out. Looks at no more than kMaxContourPoints. Returns the number of edges used.
int add_contour_term(std::span<const ContourPoint> contour, const Pinhole& camera, const Pose& D,
                     const ContourTermOptions& options, NormalEquations& into);

}  // namespace st
