// A cube of float values, the input of 3-D SIFT: x fastest, then y, then z. Value (x, y, z) lies at
// origin_m + voxel_m * (x, y, z) in the object's frame.
#pragma once

#include <cstddef>
#include <span>

#include "algo/core/linear.hpp"

namespace st {

struct Grid {
  int side = 0;
  float voxel_m = 1;
  Vec3f origin_m{};
  std::span<float> values;

  std::size_t count() const {
    const auto n = static_cast<std::size_t>(side);
    return n * n * n;
  }
  std::size_t index(int x, int y, int z) const {
    const auto n = static_cast<std::size_t>(side);
    return (static_cast<std::size_t>(z) * n + static_cast<std::size_t>(y)) * n + static_cast<std::size_t>(x);
  }
  float& operator()(int x, int y, int z) const { return values[index(x, y, z)]; }
  Vec3f position(const Vec3f& voxel) const { return origin_m + voxel * voxel_m; }
};

}  // namespace st
