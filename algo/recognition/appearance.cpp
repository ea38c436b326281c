#include "algo/recognition/appearance.hpp"

#include <cmath>

namespace st {
namespace {

constexpr float kDark = 0.3f, kUncoloured = 0.65f, kReachVoxels = 1.5f;

float luminance_of(std::uint32_t c) {
  if (color_trust_of(c) == 0) return kUncoloured;
  const float grey = 0.299f * static_cast<float>(red_of(c)) + 0.587f * static_cast<float>(green_of(c)) +
                     0.114f * static_cast<float>(blue_of(c));
  return kDark + (1 - kDark) * grey / 255;
}

// The volume's voxel nearest to p; -1: outside.
std::ptrdiff_t nearest_voxel(const Volume& v, const Vec3f& p) {
  const Vec3f q = (p - v.origin) * (1.0f / v.voxel_m) + Vec3f{0.5f, 0.5f, 0.5f};
  const float n = static_cast<float>(v.side);
  if (!(q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < n && q.y < n && q.z < n)) return -1;
  return static_cast<std::ptrdiff_t>(
      v.index(static_cast<int>(q.x), static_cast<int>(q.y), static_cast<int>(q.z)));
}

}  // namespace

float appearance_voxel_m(float extent_m) {
  constexpr float kFilled = 52, kFinest_m = 0.004f, kStep = 1.41421356f;
  float voxel_m = kFinest_m;
  for (int i = 0; i < 16 && voxel_m * kFilled < extent_m; ++i) voxel_m *= kStep;
  return voxel_m;
}

void place_appearance(Grid& grid, float extent_m, const Vec3f& centre) {
  grid.voxel_m = appearance_voxel_m(extent_m);
  const float half = 0.5f * static_cast<float>(grid.side - 1) * grid.voxel_m;
  grid.origin_m = centre - Vec3f{half, half, half};
}

void fill_appearance(const Volume& v, const Grid& grid, int z0, int z1) {
  const float reach_m = kReachVoxels * grid.voxel_m, to_m = v.truncation_m / kTsdfScale;
  for (int z = z0; z < z1; ++z)
    for (int y = 0; y < grid.side; ++y)
      for (int x = 0; x < grid.side; ++x) {
        float& out = grid(x, y, z);
        out = 0;
        const Vec3f p = grid.position({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
        const std::ptrdiff_t at = nearest_voxel(v, p);
        if (at < 0) continue;
        const auto i = static_cast<std::size_t>(at);
        const std::int16_t tsdf = v.tsdf[i];
        // Beyond the truncation the distance is not known; there it only says: not here.
        if (tsdf == kUnseen || tsdf >= 32767 || tsdf <= -32767) continue;
        const SdfSample between = sample(v, p);
        const float distance_m = std::fabs(between.valid ? between.sdf_m : static_cast<float>(tsdf) * to_m);
        if (distance_m < reach_m) out = (1 - distance_m / reach_m) * luminance_of(v.color[i]);
      }
}

}  // namespace st
