#include "algo/recognition/appearance.hpp"

#include <cmath>

namespace st {
namespace {

constexpr float kDark = 0.15f, kMiddle = 0.5f;

// The same in any light: the surface's mean is kMiddle.
float brightness_of(const ColorSample& c, const Appearance& how) {
  if (!c.valid || !(how.mean_luminance > 0)) return kMiddle;
  const float grey = 0.299f * c.r + 0.587f * c.g + 0.114f * c.b;
  const float value = kDark + (kMiddle - kDark) * grey / how.mean_luminance;
  return value < 1 ? value : 1;
}

// The volume's distance in the voxel nearest to p, metres; +truncation where nothing is known.
float coarse_distance_m(const Volume& v, const Vec3f& p) {
  const Vec3f q = (p - v.origin) * (1.0f / v.voxel_m) + Vec3f{0.5f, 0.5f, 0.5f};
  const float n = static_cast<float>(v.side);
  if (!(q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < n && q.y < n && q.z < n)) return v.truncation_m;
  const std::int16_t tsdf =
      v.tsdf[v.index(static_cast<int>(q.x), static_cast<int>(q.y), static_cast<int>(q.z))];
  return tsdf == kUnseen ? v.truncation_m : static_cast<float>(tsdf) * v.truncation_m / kTsdfScale;
}

void fill_column(const Volume& v, const Appearance& how, const Grid& grid, int x, int y) {
  float print = 0;  // of the topmost surface; 0: still above it
  for (int z = grid.side - 1; z >= 0; --z) {
    float& out = grid(x, y, z);
    out = 0;
    const Vec3f p = grid.position({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    // The floor cuts its voxel where it lies in it.
    const float above_floor = (p.z - how.floor_z_m) / grid.voxel_m + 0.5f;
    if (above_floor <= 0) continue;
    const float distance_m = coarse_distance_m(v, p);
    const bool at_surface = std::fabs(distance_m) < 0.75f * grid.voxel_m;
    if (print == 0 && distance_m > 0.5f * grid.voxel_m) continue;
    if (print == 0 && p.z < how.least_top_m) return;
    float brightness = print;
    if (at_surface || print == 0) {
      const ColorSample color = sample_color(v, p);
      if (color.valid || print == 0) brightness = brightness_of(color, how);
      if (print == 0 && (color.valid || distance_m <= 0)) print = brightness;
    }
    const bool on_top = distance_m > -0.5f * grid.voxel_m && distance_m < 0.5f * grid.voxel_m;
    const float occupancy = on_top ? 0.5f - distance_m / grid.voxel_m : 1.0f;
    out = brightness * occupancy * (above_floor < 1 ? above_floor : 1.0f);
  }
}

}  // namespace

float appearance_voxel_m(float extent_m) {
  constexpr float kFilled = 52, kFinest_m = 0.004f, kStep = 1.41421356f;
  float voxel_m = kFinest_m;
  for (int i = 0; i < 16 && voxel_m * kFilled < extent_m; ++i) voxel_m *= kStep;
  return voxel_m;
}

void place_appearance(Grid& grid, const Bounds& bounds) {
  const Vec3 size = bounds.size();
  const double wide = size.x > size.y ? size.x : size.y;
  grid.voxel_m = appearance_voxel_m(static_cast<float>(wide > size.z ? wide : size.z));
  const float half = 0.5f * static_cast<float>(grid.side - 1) * grid.voxel_m;
  grid.origin_m = to_float(bounds.centre()) - Vec3f{half, half, half};
}

void fill_appearance(const Volume& volume, const Appearance& how, const Grid& grid, int y0, int y1) {
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < grid.side; ++x) fill_column(volume, how, grid, x, y);
}

}  // namespace st
