#include "algo/tracking/kd_tree.hpp"

#include <algorithm>

namespace st {
namespace {

constexpr std::size_t kLeaf = 8;  // ranges up to this long are looked through
// Every split halves a range, and one half waits: log2(kMostPoints / kLeaf) of them, and one to spare.
constexpr std::size_t kWaiting = 14;
static_assert(KdTree::kMostPoints <= kLeaf << (kWaiting - 2));

struct Range {
  std::size_t first, last;  // half open
  float gap2_m2 = 0;        // least square distance of what is in it
  std::size_t size() const { return last - first; }
  std::size_t middle() const { return first + size() / 2; }
};

int widest_axis(std::span<const Vec3f> points) {
  Vec3f low = points[0], high = points[0];
  for (const Vec3f& p : points)
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  const Vec3f size = high - low;
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

}  // namespace

void KdTree::bind(Bump& memory, std::size_t capacity) {
  const std::size_t room = std::min(capacity, kMostPoints);
  points_ = memory.take<Vec3f>(room);
  axis_ = memory.take<std::uint8_t>(room);
  count_ = 0;
}

void KdTree::build(std::size_t count) {
  count_ = std::min(count, points_.size());
  Range waiting[kWaiting];
  std::size_t depth = 0;
  waiting[depth++] = {0, count_};
  while (depth > 0) {  // once for each inner range: less than count / kLeaf * 2
    const Range range = waiting[--depth];
    if (range.size() <= kLeaf) continue;
    const int axis = widest_axis(points_.subspan(range.first, range.size()));
    const auto at = [this](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(range.first), at(range.middle()), at(range.last),
                     [axis](const Vec3f& a, const Vec3f& b) { return a[axis] < b[axis]; });
    axis_[range.middle()] = static_cast<std::uint8_t>(axis);
    waiting[depth++] = {range.first, range.middle()};
    waiting[depth++] = {range.middle() + 1, range.last};
  }
}

KdTree::Nearest KdTree::nearest(const Vec3f& p) const {
  Nearest best;
  const auto look_at = [&](std::size_t i) {
    const Vec3f d = points_[i] - p;
    const float distance2 = dot(d, d);
    if (distance2 < best.distance2_m2) best = {i, distance2};
  };
  Range waiting[kWaiting];
  std::size_t depth = 0;
  waiting[depth++] = {0, count_};
  while (depth > 0) {  // each point is looked at once at most
    Range range = waiting[--depth];
    if (range.gap2_m2 >= best.distance2_m2) continue;
    while (range.size() > kLeaf) {
      const std::size_t middle = range.middle();
      look_at(middle);
      const int axis = axis_[middle];
      const float gap = p[axis] - points_[middle][axis];
      const Range below{range.first, middle}, above{middle + 1, range.last};
      Range& far = waiting[depth++];
      far = gap < 0 ? above : below;
      far.gap2_m2 = std::max(range.gap2_m2, gap * gap);
      const float near_gap2 = range.gap2_m2;
      range = gap < 0 ? below : above;
      range.gap2_m2 = near_gap2;
    }
    for (std::size_t i = range.first; i < range.last; ++i) look_at(i);
  }
  return best;
}

}  // namespace st
