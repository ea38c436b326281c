// The depth camera without distortion: frames are made ideal when they come in (algo/depth).
#pragma once

#include <cmath>

#include "algo/core/calibration.hpp"

namespace st {

struct Pinhole {
  float fx = 1, fy = 1, cx = 0, cy = 0;
  int width = 0, height = 0;

  static Pinhole of(const Intrinsics& k) {
    return {static_cast<float>(k.fx),
            static_cast<float>(k.fy),
            static_cast<float>(k.cx),
            static_cast<float>(k.cy),
            k.width,
            k.height};
  }
  Vec3f ray(float u, float v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0f}; }
  // The pixel that sees p, which lies in front of the camera (p.z > 0); it may be outside of the image.
  struct Pixel {
    int u, v;
  };
  Pixel pixel_of(const Vec3f& p) const {
    return {static_cast<int>(std::floor(fx * p.x / p.z + cx + 0.5f)),
            static_cast<int>(std::floor(fy * p.y / p.z + cy + 0.5f))};
  }
};

// The camera of an image that is `step` times coarser; its pixel (0, 0) is the mean of the first step x step
// pixels.
constexpr Pinhole coarser(const Pinhole& k, int step) {
  const float s = static_cast<float>(step);
  return {k.fx / s,       k.fy / s,       (k.cx + 0.5f) / s - 0.5f, (k.cy + 0.5f) / s - 0.5f,
          k.width / step, k.height / step};
}

}  // namespace st
