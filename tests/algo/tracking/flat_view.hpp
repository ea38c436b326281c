// A model view painted by hand: a plane before the camera, for tests of single terms.
#pragma once

#include <vector>

#include "algo/tracking/model_view.hpp"

namespace st::test {

inline constexpr Pinhole kSmallCamera{144, 144, 79.5f, 59.5f, 160, 120};

// The plane n . p = offset over the pixels of `roi`, whose normal n (unit, towards the camera) is given.
struct FlatView {
  ModelView view;
  std::vector<float> z;
  std::vector<std::uint32_t> normal, color;

  FlatView(const Rect& roi, const Vec3f& n, float offset, const Pinhole& camera = kSmallCamera) {
    const std::size_t pixels = static_cast<std::size_t>(roi.width()) * static_cast<std::size_t>(roi.height());
    z.resize(pixels);
    color.assign(pixels, 0);
    const auto part = [](float x) { return static_cast<std::uint16_t>(static_cast<int>(x * kNormalScale)); };
    normal.assign(pixels, static_cast<std::uint32_t>(part(n.x)) | static_cast<std::uint32_t>(part(n.y))
                                                                      << 16);
    view.maps.roi = roi;
    view.maps.stride = roi.width();
    view.maps.z = z;
    view.maps.normal = normal;
    view.maps.color = color;
    for (int v = roi.v0; v < roi.v1; ++v)
      for (int u = roi.u0; u < roi.u1; ++u)
        z[view.maps.at(u, v)] = offset / dot(n, camera.ray(static_cast<float>(u), static_cast<float>(v)));
  }
  FlatView(const FlatView&) = delete;
  FlatView& operator=(const FlatView&) = delete;
};

}  // namespace st::test
