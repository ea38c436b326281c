// Projective data association and point-to-plane residuals (KinectFusion, Newcombe et al. 2011, section 3.5).
#pragma once

#include "algo/tracking/normal_equations.hpp"
#include "algo/tracking/point_table.hpp"
#include "algo/tracking/view_table.hpp"

namespace st {

struct DepthTermOptions {
  float gate_m = 0.05f;  // pairs farther apart than this, and than four sigma of the depth, are not pairs
  float robust_sigmas = 4.0f;  // Tukey's biweight reaches zero here
  // Neighbouring pixels share the matching window of the sensor, and its steps stand still in the image while
  // the object moves: so many pixels count as one measurement. Less makes a flat, round object stick to its
  // old heading.
  float correlated_pixels = 30.0f;
};

struct DepthTermResult {
  int tried = 0;     // points looked at
  int paired = 0;    // with a model surface in reach
  int inliers = 0;   // within three sigma
  double rms_m = 0;  // of the inliers
};

// Adds the depth term of the first `count` points at the pose T = D * view.T_camera_object, D given. Rotation
// is taken about pivot (camera frame).
DepthTermResult add_depth_term(const PointTable& points, std::size_t count, const ViewTable& view,
                               const Pinhole& camera, const Pose& D, const Vec3& pivot,
                               const DepthTermOptions& options, NormalEquations& into);

}  // namespace st
