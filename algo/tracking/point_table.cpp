#include "algo/tracking/point_table.hpp"

namespace st {
namespace {

constexpr std::size_t kPhases = 8;
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

void arrange_points(std::span<const ObservedPoint> points, std::size_t most, PointTable& table) {
  const std::size_t limit = most < PointTable::kMost ? most : PointTable::kMost;
  table.available = points.size();
  table.count = points.size() < limit ? points.size() : limit;
  std::size_t used = 0;
  for (const std::size_t phase : kPhaseOrder) {
    for (std::size_t i = phase; i < table.count; i += kPhases) {
      const ObservedPoint& point = points[i * points.size() / table.count];
      table.x[used] = point.p.x;
      table.y[used] = point.p.y;
      table.z[used] = point.p.z;
      table.luminance[used] = point.luminance;
      ++used;
    }
  }
  for (std::size_t i = used; i < used + PointTable::kPadding; ++i)
    table.x[i] = table.y[i] = table.z[i] = 0, table.luminance[i] = -1;
}

}  // namespace st
