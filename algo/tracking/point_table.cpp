#include "algo/tracking/point_table.hpp"

namespace st {
namespace {

constexpr std::size_t kPhases = 8;
// Which phase of the scan comes when. Bits reversed, so it is its own inverse.
constexpr std::size_t kPhaseOrder[kPhases] = {0, 4, 2, 6, 1, 5, 3, 7};

}  // namespace

void PointTable::bind(Bump& memory) {
  for (std::span<float>* column : {&x, &y, &z, &luminance}) *column = memory.take<float>(kMost + kPadding);
}

std::size_t PointTable::prefix(std::size_t wanted) const {
  std::size_t share = kPhases;
  while (share > 1 && (count + share - 1) / share < wanted) share /= 2;
  return (count + share - 1) / share;
}

void PointTable::begin(std::size_t of, std::size_t most) {
  const std::size_t limit = most < kMost ? most : kMost;
  available = of;
  count = of < limit ? of : limit;
  for (std::size_t i = count; i < count + kPadding; ++i) x[i] = y[i] = z[i] = luminance[i] = 0;
}

void PointTable::put(std::size_t k, const Vec3f& p, float grey) {
  std::size_t at = k / kPhases;
  for (std::size_t rank = 0; rank < kPhaseOrder[k % kPhases]; ++rank)
    at += (count + kPhases - 1 - kPhaseOrder[rank]) / kPhases;  // the points of an earlier phase
  x[at] = p.x;
  y[at] = p.y;
  z[at] = p.z;
  luminance[at] = grey;
}

void arrange_points(std::span<const ObservedPoint> points, std::size_t most, PointTable& table) {
  table.begin(points.size(), most);
  for (std::size_t k = 0; k < table.count; ++k) table.put(k, points[table.source(k)].p, 0);
}

}  // namespace st
