// A colour image made from a function of the pixel, as the alignment reads it; its camera is the depth
// camera, or one that sees the same with other numbers.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "algo/tracking/color_frame.hpp"
#include "tests/support/bound.hpp"

namespace st::test {

inline Intrinsics intrinsics_of(const Pinhole& camera) {
  Intrinsics k{};
  k.width = camera.width, k.height = camera.height;
  k.fx = camera.fx, k.fy = camera.fy, k.cx = camera.cx, k.cy = camera.cy;
  return k;
}

struct SeenColors {
  std::vector<std::uint8_t> rgb;
  ColorRegistration registration;
  ColorFrame frame;
  BoundMemory memory;

  SeenColors(const Pinhole& depth, const std::function<double(int, int)>& grey)
      : SeenColors(registered(depth), depth, grey) {}
  SeenColors(const Calibration& calibration, const Pinhole& depth,
             const std::function<double(int, int)>& grey)
      : memory([&](Bump& b) {
          const Intrinsics& k = calibration.color_registered ? calibration.depth : calibration.color;
          frame.bind(b, k.width, k.height);
        }) {
    registration.configure(calibration);
    const Intrinsics& k = registration.camera();
    for (int v = 0; v < k.height; ++v)
      for (int u = 0; u < k.width; ++u) rgb.insert(rgb.end(), 3, static_cast<std::uint8_t>(grey(u, v) + 0.5));
    build_color_frame(registration, image(), depth, {0, 0, depth.width, depth.height}, frame);
  }
  ColorImage image() const {
    const Intrinsics& k = registration.camera();
    return {{rgb.data(), 3 * k.width, k.height}};
  }
  static Calibration registered(const Pinhole& depth) {
    Calibration calibration;
    calibration.depth = intrinsics_of(depth);
    calibration.color_registered = true;
    return calibration;
  }
  // Grey levels at a pixel of the colour image; -1 where there is none.
  double at(int u, int v) const {
    const Rect& roi = frame.roi;
    if (u < roi.u0 || v < roi.v0 || u >= roi.u1 || v >= roi.v1) return -1;
    const ColorPixel& pixel =
        frame.pixels[static_cast<std::size_t>((v - roi.v0) * roi.width() + u - roi.u0) + 1];
    return pixel.luminance == kNoColor ? -1 : pixel.luminance / double{kLuminanceScale};
  }
};

}  // namespace st::test
