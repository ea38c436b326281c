// The vector part of align_camera(): every pixel of a depth image against the view of the scene, associated
// and summed in one pass. Plain arrays; see camera_align.hpp for meanings.
#pragma once

#include <cstdint>

namespace st {

struct CameraKernel {
  // Depth image, metres, 0: none. The ray of pixel (u, v) is ((u - cx) per_fx, (v - cy) per_fy, 1).
  const float* z;
  int width, height;
  float cx, cy, per_fx, per_fy;
  // View of the scene: the camera at full size.
  const float* view_z;
  const std::uint32_t* view_normal;
  int view_width, view_height, view_stride;
  float view_fx, view_fy, view_cx, view_cy;
  float R[9], t[3];  // p_view = R p + t
  float gate2_m2;    // squared distance beyond which two surfaces are not the same
  float robust2;     // squared sigmas at which Tukey's biweight reaches zero
  // Results: sums of w J J^T (upper triangle by rows), of w J r, and of the inliers' r^2.
  double triangle[21]{}, gradient[6]{}, square_sum = 0;
  int readings = 0, facing = 0, paired = 0, inliers = 0;
};

void accumulate_camera(CameraKernel& work);

}  // namespace st
