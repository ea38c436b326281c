// Photometric residuals of the present colour image against the model's own colours (Kerl et al. 2013, Park
// et al. 2017), with a gain and offset per frame and a small shift of the colour image as nuisance unknowns:
// colour registered a pixel off looks like a moved object, not like a turned one, so the shift takes that
// error and leaves the turn.
#pragma once

#include "algo/tracking/normal_equations.hpp"
#include "algo/tracking/point_table.hpp"
#include "algo/tracking/view_table.hpp"

namespace st {

struct ColorGain {
  float gain = 1, offset = 0;
};

struct ColorTermOptions {
  float gate_m = 0.03f;
  float correlated_pixels = 6.0f;
  float least_gradient = 2.0f;  // grey levels per pixel below which a pixel says nothing
};

struct ColorTermResult {
  int used = 0;
  float sigma = 0;  // robust scale of the residuals, grey levels
};

// Fits present = gain * model + offset over the pairs of a share of the first `count` points, robustly; {1,
// 0} where there are too few.
ColorGain fit_color_gain(const PointTable& points, std::size_t count, const ViewTable& view,
                         const Pinhole& camera, const Pose& D, const ColorTermOptions& options);

// Adds the colour term of the first `count` points at the pose D * view.T_camera_object with the colour image
// shifted by (shift_u, shift_v) pixels.
ColorTermResult add_color_term(const PointTable& points, std::size_t count, const ViewTable& view,
                               const Pinhole& camera, const Pose& D, const Vec3& pivot, ColorGain gain,
                               const double (&shift_px)[2], const ColorTermOptions& options,
                               NormalEquations& into);

}  // namespace st
