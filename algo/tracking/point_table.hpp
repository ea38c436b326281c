// Points of an image scan as the residual terms read them: columns for the vector kernels, in an order in
// which the first half, quarter and eighth are spread over the whole object, too. A coarse look is a short
// prefix.
#pragma once

#include <cstddef>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/tracking/model_view.hpp"

namespace st {

struct PointTable {
  static constexpr std::size_t kMost = 6000;
  static constexpr std::size_t kPadding = 16;  // kernels load whole vectors

  std::span<float> x, y, z;    // camera frame, metres
  std::span<float> luminance;  // of the model's points, 0-255
  std::size_t count = 0;
  std::size_t available = 0;  // points that it was thinned from

  void bind(Bump& memory);
  // Begins anew for `of` points, of which at most `most` (and kMost) are kept, thinned evenly: count is set,
  // and the k-th of them is the point that source(k) says.
  void begin(std::size_t of, std::size_t most);
  std::size_t source(std::size_t k) const { return k * available / count; }
  void put(std::size_t k, const Vec3f& p, float grey);  // every k below count, in any order
  // Length of the shortest evenly spread prefix with at least `wanted` points.
  std::size_t prefix(std::size_t wanted) const;
  // Observed pixels that each of the first `used` points stands for.
  float thinning(std::size_t used) const {
    return used > 0 ? static_cast<float>(available) / static_cast<float>(used) : 1.0f;
  }
};

// At most `most` (and PointTable::kMost) of the points, thinned evenly.
void arrange_points(std::span<const ObservedPoint> points, std::size_t most, PointTable& table);

}  // namespace st
