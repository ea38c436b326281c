// The model's view as the residual terms read it: what belongs to a pixel lies in one record, so that a
// paired point costs one cache line instead of eleven.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/tracking/color_frame.hpp"
#include "algo/tracking/model_view.hpp"

namespace st {

// The kernels read it as three 32-bit words, hence the order.
struct ViewPixel {
  float z = 0;                          // metres; 0: no surface
  std::int16_t nx = 0, ny = 0, nz = 0;  // normal times kNormalScale, view's camera frame
  std::int16_t luminance = kNoColor;    // times kLuminanceScale
};
static_assert(sizeof(ViewPixel) == 12);

struct ViewTable {
  Rect roi;
  Pose T_camera_object;
  // The first record is empty and stands for everything outside of `roi`; the rectangle follows, row by row.
  std::span<ViewPixel> pixels;

  void bind(Bump& memory, int max_width, int max_height);
  bool contains(int u, int v) const { return u >= roi.u0 && v >= roi.v0 && u < roi.u1 && v < roi.v1; }
  const ViewPixel& at(int u, int v) const {
    return pixels[contains(u, v) ? static_cast<std::size_t>((v - roi.v0) * roi.width() + u - roi.u0) + 1 : 0];
  }
};

// A pixel has a colour where it and its four neighbours have one and lie on one surface: at an edge the
// camera mixes it with what lies behind.
void build_view_table(const ModelView& view, ViewTable& table);

}  // namespace st
