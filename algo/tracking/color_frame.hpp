// The colour image as the colour term reads it: luminance and slope in one record per pixel, made ideal, over
// the rectangle in which objects may be. The model is looked up in it, not it in the model: dark and glossy
// places that return no depth show their colours all the same.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/pinhole.hpp"
#include "algo/core/pose.hpp"
#include "algo/tracking/observe.hpp"

namespace st {

inline constexpr float kLuminanceScale = 64.0f;  // steps of a grey level
inline constexpr std::int16_t kNoColor = -32768;

// The kernel reads it as two 32-bit words, hence the order.
struct ColorPixel {
  std::int16_t luminance = kNoColor;  // times kLuminanceScale, smoothed by a binomial 3x3
  std::int16_t reserved = 0;
  std::int16_t du = 0, dv = 0;  // central differences of it per pixel, times kLuminanceScale
};
static_assert(sizeof(ColorPixel) == 8);

struct ColorFrame {
  Rect roi;        // of the colour image
  Pinhole camera;  // the colour camera, ideal
  PoseF T_color_depth;
  // The first record is empty and stands for everything outside of `roi`; the rectangle follows, row by row.
  std::span<ColorPixel> pixels;
  std::span<std::int16_t> grey;  // work memory: luminance before smoothing

  void bind(Bump& memory, int width, int height);  // of the colour image
  bool empty() const { return roi.empty(); }
};

// Takes over the part of the image in which the depth camera's pixels `depth_box` may appear, at any distance
// between 0.4 m and far away.
void build_color_frame(const ColorRegistration& registration, const ColorImage& image,
                       const Pinhole& depth_camera, const Rect& depth_box, ColorFrame& frame);

}  // namespace st
