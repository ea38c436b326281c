#include "algo/volume/raycast.hpp"

#include <cstring>

#include "algo/volume/brick_view.hpp"
#include "algo/volume/march_kernel.hpp"

namespace st {
namespace {

// Twelve frames at the nominal distance.
constexpr std::uint32_t kYoungWeight = static_cast<std::uint32_t>(12 * kWeightUnits);

constexpr int up(int n, int to) { return (n + to - 1) / to * to; }
constexpr std::size_t area(int w, int h) { return static_cast<std::size_t>(w) * static_cast<std::size_t>(h); }

// Calls with(bounds) for every solid octant of a brick that may fall on the rectangle. A crossing lies at
// most one voxel away from the solid side's outermost voxel.
template <typename F>
void for_solid(const Volume& v, const Pinhole& camera, const Rect& roi, const Pose& T, F&& with) {
  constexpr int kOctant = kBrickSide / 2;
  const BrickView view(v, camera, roi, T, kOctant, 1.0f);
  const int b = v.bricks_a_side();
  for (int z = 0; z < b; ++z)
    for (int y = 0; y < b; ++y) {
      const std::uint8_t* row = &v.octants[v.brick_index(0, y, z)];
      for (int x = 0; x < b; ++x) {
        if (row[x] == 0) continue;
        for (int i = 0; i < 8; ++i) {
          if (((row[x] >> i) & 1) == 0) continue;
          const BrickBounds bounds =
              view.of(x * kBrickSide + kOctant * (i & 1), y * kBrickSide + kOctant * ((i >> 1) & 1),
                      z * kBrickSide + kOctant * (i >> 2));
          if (!bounds.rect.clipped(roi.width(), roi.height()).empty()) with(bounds);
        }
      }
    }
}

// Pixels to the outer pair that normals are fitted to: about a centimetre, which noise in a young model
// needs.
constexpr int kLeastReach = 3, kMostReach = 8;
int normal_reach(const Pinhole& camera, float z_m) {
  constexpr float kSpan_m = 0.01f;
  const float pixels = kSpan_m * camera.fx / z_m;
  return pixels > kLeastReach ? pixels < kMostReach ? static_cast<int>(pixels) : kMostReach : kLeastReach;
}

}  // namespace

void ModelMaps::bind(Bump& memory, int max_width, int max_height) {
  const std::size_t n = area(up(max_width, kRayTile), max_height);
  z = memory.take<float>(n);
  normal = memory.take<std::uint32_t>(n);
  color = memory.take<std::uint32_t>(n);
  weight = memory.take<std::uint8_t>(n);
}

void RaycastScratch::bind(Bump& memory, int max_width, int max_height) {
  const std::size_t n = area(up(max_width, kRayTile) / kRayTile, up(max_height, kRayTile) / kRayTile);
  nearest = memory.take<float>(n);
  farthest = memory.take<float>(n);
  depth = memory.take<float>(area(up(max_width, kRayTile) + 2 * kRayMargin, max_height + 2 * kRayMargin));
}

RaycastStats raycast(const Volume& volume, const Pinhole& camera, const Rect& roi,
                     const Pose& T_camera_object, RaycastScratch& scratch, ModelMaps& out,
                     const RaycastOptions& options) {
  out.roi = roi.clipped(camera.width, camera.height);
  if (out.roi.empty()) out.roi = {0, 0, 0, 0};
  out.stride = up(out.roi.width(), kRayTile);
  const int wide = out.stride / kRayTile, high = up(out.roi.height(), kRayTile) / kRayTile;
  for (std::size_t i = 0; i < area(wide, high); ++i) {
    scratch.nearest[i] = 1e9f;
    scratch.farthest[i] = 0;
  }
  for_solid(volume, camera, out.roi, T_camera_object, [&](const BrickBounds& b) {
    const Rect r = b.rect.clipped(out.roi.width(), out.roi.height());
    for (int v = r.v0 / kRayTile; v <= (r.v1 - 1) / kRayTile; ++v)
      for (int u = r.u0 / kRayTile; u <= (r.u1 - 1) / kRayTile; ++u) {
        const std::size_t tile = area(wide, v) + static_cast<std::size_t>(u);
        if (b.near_m < scratch.nearest[tile]) scratch.nearest[tile] = b.near_m;
        if (b.far_m > scratch.farthest[tile]) scratch.farthest[tile] = b.far_m;
      }
  });

  MarchKernel k{};
  k.side = volume.side;
  k.tsdf = volume.tsdf.data();
  k.color = options.with_color ? volume.color.data() : nullptr;
  k.weight = volume.weight.data();
  const Pose T_object_camera = T_camera_object.inverse();
  const float per_voxel = 1.0f / volume.voxel_m;
  const Vec3f eye = (to_float(T_object_camera.t) - volume.origin) * per_voxel;
  for (int a = 0; a < 3; ++a) {
    k.eye[a] = eye[a];
    for (int c = 0; c < 3; ++c)
      k.to_voxels[3 * a + c] = static_cast<float>(T_object_camera.R(a, c)) * per_voxel;
  }
  k.fx = camera.fx;
  k.fy = camera.fy;
  k.per_fx = 1.0f / camera.fx;
  k.per_fy = 1.0f / camera.fy;
  k.cx = camera.cx - static_cast<float>(out.roi.u0);
  k.cy = camera.cy - static_cast<float>(out.roi.v0);
  k.truncation_voxels = volume.truncation_m * per_voxel;
  k.width = out.roi.width();
  k.height = out.roi.height();
  k.stride = out.stride;
  k.nearest = scratch.nearest.data();
  k.farthest = scratch.farthest.data();
  k.normal_reach = normal_reach(camera, (to_float(T_camera_object) * volume.centre()).z);
  if (!options.guess.empty()) {
    k.seed = options.guess.row(out.roi.v0) + out.roi.u0;
    k.seed_stride = options.guess.width;
    k.seed_reach = kGuessReach * volume.truncation_m;
  }
  k.young_reach = options.smooth_young ? kRayMargin - 2 : 0;
  k.young_weight = kYoungWeight;
  k.padded_stride = out.stride + 2 * kRayMargin;
  const std::size_t padded = area(k.padded_stride, out.roi.height() + 2 * kRayMargin);
  std::memset(scratch.depth.data(), 0, padded * sizeof(float));
  k.depth = scratch.depth.data() + static_cast<std::ptrdiff_t>(kRayMargin) * k.padded_stride + kRayMargin;
  k.z = out.z.data();
  k.normal = out.normal.data();
  k.out_color = out.color.data();
  k.out_weight = out.weight.data();
  march_rays(k);
  return {k.rays, k.hits};
}

Rect visible_rect(const Volume& volume, const Pinhole& camera, const Pose& T_camera_object) {
  const Rect image{0, 0, camera.width, camera.height};
  Rect all = Rect::nothing();
  for_solid(volume, camera, image, T_camera_object, [&](const BrickBounds& b) {
    const Rect r = b.rect.clipped(image.u1, image.v1);
    all.include(r.u0, r.v0);
    all.include(r.u1 - 1, r.v1 - 1);
  });
  return all.empty() ? Rect{0, 0, 0, 0} : all;
}

}  // namespace st
