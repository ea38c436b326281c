#include "algo/volume/surface_points.hpp"

namespace st {
namespace {

constexpr int kOctantSide = kBrickSide / 2;

// Calls visit(inside voxel's index, its place, axis, step) for every pair of voxels, side by side, of which
// one is inside and the other seen and outside. The one inside lies in a solid octant: no other is visited.
template <typename Visit>
void for_crossings(const Volume& v, const Visit& visit) {
  const std::size_t n = static_cast<std::size_t>(v.side);
  const std::size_t strides[3] = {1, n, n * n};
  const auto octant = [&](int x0, int y0, int z0) {
    for (int z = z0; z < z0 + kOctantSide; ++z)
      for (int y = y0; y < y0 + kOctantSide; ++y)
        for (int x = x0; x < x0 + kOctantSide; ++x) {
          const std::size_t at = v.index(x, y, z);
          if (v.tsdf[at] >= 0 || v.tsdf[at] == kUnseen) continue;
          const int place[3] = {x, y, z};
          for (int axis = 0; axis < 3; ++axis) {
            if (place[axis] > 0 && v.tsdf[at - strides[axis]] >= 0) visit(at, place, axis, -1);
            if (place[axis] + 1 < v.side && v.tsdf[at + strides[axis]] >= 0) visit(at, place, axis, 1);
          }
        }
  };
  const int b = v.bricks_a_side();
  for (int z = 0; z < b; ++z)
    for (int y = 0; y < b; ++y)
      for (int x = 0; x < b; ++x) {
        const std::size_t brick = v.brick_index(x, y, z);
        if ((v.bricks[brick] & kBrickSolid) == 0) continue;
        for (int i = 0; i < 8; ++i)
          if ((v.octants[brick] >> i & 1) != 0)
            octant(x * kBrickSide + (i & 1) * kOctantSide, y * kBrickSide + (i >> 1 & 1) * kOctantSide,
                   z * kBrickSide + (i >> 2) * kOctantSide);
      }
}

}  // namespace

std::size_t surface_points(const Volume& v, std::span<Vec3f> out) {
  std::size_t crossings = 0, seen = 0, written = 0;
  for_crossings(v, [&](std::size_t, const int(&)[3], int, int) { ++crossings; });
  if (crossings == 0 || out.empty()) return 0;
  const std::size_t every = (crossings + out.size() - 1) / out.size();
  const std::size_t n = static_cast<std::size_t>(v.side);
  const std::size_t strides[3] = {1, n, n * n};
  for_crossings(v, [&](std::size_t at, const int(&place)[3], int axis, int step) {
    if (seen++ % every != 0) return;
    const float inside = v.tsdf[at];
    const float outside = v.tsdf[step > 0 ? at + strides[axis] : at - strides[axis]];
    Vec3f p = v.position(place[0], place[1], place[2]);
    p[axis] += static_cast<float>(step) * v.voxel_m * inside / (inside - outside);
    out[written++] = p;
  });
  return written;
}

}  // namespace st
