// Closest points in a fixed set (Bentley 1975): a balanced tree over points in the caller's memory, without a
// node of its own. The middle of each range splits it, so the order of the points is the tree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/linear.hpp"

namespace st {

class KdTree {
 public:
  static constexpr std::size_t kMostPoints = 32768;

  void bind(Bump& memory, std::size_t capacity);

  // Room to write points to; build() then makes a tree of the first `count` and changes their order.
  std::span<Vec3f> room() { return points_; }
  void build(std::size_t count);

  std::span<const Vec3f> points() const { return points_.first(count_); }

  // The point closest to `p`, exactly: index into points(), and the square of its distance.
  struct Nearest {
    std::size_t index = 0;
    float distance2_m2 = 1e30f;
  };
  Nearest nearest(const Vec3f& p) const;  // index 0 and 1e30 when there is none

 private:
  std::span<Vec3f> points_;
  std::span<std::uint8_t> axis_;  // along which the point in the middle of a range splits it
  std::size_t count_ = 0;
};

}  // namespace st
