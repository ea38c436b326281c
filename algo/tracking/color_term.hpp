// Photometric residuals of the present colour image where the model's coloured points fall in it (direct
// alignment: Kerl et al. 2013, Park et al. 2017), with a gain and offset per frame and a small shift of the
// colour image as nuisance unknowns: colour registered a pixel off looks like a moved object, not like a
// turned one, so the shift takes that error and leaves the turn.
#pragma once

#include "algo/tracking/color_frame.hpp"
#include "algo/tracking/normal_equations.hpp"
#include "algo/tracking/point_table.hpp"
#include "algo/tracking/view_table.hpp"

namespace st {

struct ColorGain {
  float gain = 1, offset = 0;
};

struct ColorTermOptions {
  float gate_m =
      0.03f;  // depth that is nearer or farther than the model by more than this hides it, or is not it
  float correlated_pixels = 6.0f;
  float least_gradient = 2.0f;  // grey levels per pixel below which a pixel says nothing
};

struct ColorTermResult {
  int used = 0;
  float sigma = 0;  // robust scale of the residuals, grey levels
};

// The view's coloured pixels that the frame does not contradict at the pose D * view.T_camera_object, in the
// view's camera frame, thinned evenly to `most`.
void collect_color_points(const ViewTable& view, const Pinhole& camera, ImageView<const float> depth_z,
                          const Pose& D, const ColorTermOptions& options, std::size_t most,
                          PointTable& points);

// Where the model is when the colour image is taken: p in the view's camera frame is at then * p in the depth
// camera's.
struct ColorLook {
  const PointTable& points;
  std::size_t count;  // the first so many are looked at
  const ColorFrame& frame;
  Pose then;
};

// Fits present = gain * model + offset over a share of the points, robustly; {1, 0} where there are too few.
ColorGain fit_color_gain(const ColorLook& look);

// Adds the colour term with the colour image shifted by (shift_u, shift_v) pixels; rotation is taken about
// `pivot` (depth camera's frame).
ColorTermResult add_color_term(const ColorLook& look, const Vec3& pivot, ColorGain gain,
                               const double (&shift_px)[2], const ColorTermOptions& options,
                               NormalEquations& into);

}  // namespace st
