// Projective data association as plain arrays, for the vector kernels of the residual terms.
#pragma once

#include "algo/core/pinhole.hpp"
#include "algo/tracking/point_table.hpp"
#include "algo/tracking/view_table.hpp"

namespace st {

struct Pairing {
  const float *x, *y, *z;  // points, camera frame
  int count;
  const ViewPixel* view;  // record 0 is empty, then width x height
  int width, height;
  float fx, fy, cx, cy;     // cx, cy: from the rectangle's first pixel
  float to_view[9], at[3];  // q = to_view p + at
  float back[9];            // directions of the view's frame in the present camera frame
  float pivot[3];           // camera frame
};

// Of the first `count` points with the view moved by D.
inline Pairing pairing_of(const PointTable& points, std::size_t count, const ViewTable& view,
                          const Pinhole& camera, const Pose& D, const Vec3& pivot) {
  Pairing k{};
  k.x = points.x.data();
  k.y = points.y.data();
  k.z = points.z.data();
  k.count = static_cast<int>(count);
  k.view = view.pixels.data();
  k.width = view.roi.width();
  k.height = view.roi.height();
  k.fx = camera.fx;
  k.fy = camera.fy;
  k.cx = camera.cx - static_cast<float>(view.roi.u0);
  k.cy = camera.cy - static_cast<float>(view.roi.v0);
  const PoseF to_view = to_float(D.inverse());
  const Mat3f back = to_float(D.R);
  const Vec3f c = to_float(pivot);
  for (int i = 0; i < 9; ++i) k.to_view[i] = to_view.R.m[i], k.back[i] = back.m[i];
  for (int i = 0; i < 3; ++i) k.at[i] = to_view.t[i], k.pivot[i] = c[i];
  return k;
}

}  // namespace st
