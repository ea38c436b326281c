// A room of planes as a depth camera sees it, exactly: what the camera's alignment is tested with.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "algo/depth/pyramid.hpp"
#include "algo/depth/pyramid_kernel.hpp"
#include "algo/volume/raycast.hpp"
#include "tests/support/bound.hpp"

namespace st::test {

// n . p = d, seen from the side that n points to.
struct Wall {
  Vec3 n;
  double d;
};

inline const Pinhole kRoomCamera{280, 280, 159.5f, 119.5f, 320, 240};

// The nearest wall on the ray; its number in `hit`, -1 for none. z along the ray (x, y, 1) of the camera.
inline double depth_of(std::span<const Wall> walls, const Pose& T_world_camera, const Vec3& ray, int* hit) {
  double nearest = 1e9;
  *hit = -1;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double along = dot(walls[i].n, T_world_camera.R * ray);
    const double z = along < -1e-9 ? (walls[i].d - dot(walls[i].n, T_world_camera.t)) / along : -1;
    if (z > 0 && z < nearest) nearest = z, *hit = static_cast<int>(i);
  }
  return *hit < 0 ? 0 : nearest;
}

struct RoomFrame {
  explicit RoomFrame(std::span<const Wall> walls, const Pose& T_world_camera)
      : memory([&](Bump& bump) {
          depth.bind(bump, kRoomCamera);
          view.bind(bump, kRoomCamera.width, kRoomCamera.height);
        }) {
    view.roi = {0, 0, kRoomCamera.width, kRoomCamera.height};
    view.stride = kRoomCamera.width;
    for (int v = 0; v < kRoomCamera.height; ++v)
      for (int u = 0; u < kRoomCamera.width; ++u) {
        int hit = -1;
        const Vec3 ray = to_double(kRoomCamera.ray(static_cast<float>(u), static_cast<float>(v)));
        const float z = static_cast<float>(depth_of(walls, T_world_camera, ray, &hit));
        depth.levels[0].z(u, v) = view.z[view.at(u, v)] = z;
        if (hit < 0) continue;
        const Vec3 n = T_world_camera.R.transposed() * walls[static_cast<std::size_t>(hit)].n;
        const auto part = [](double x) {
          return static_cast<std::uint32_t>(static_cast<std::uint16_t>(
              static_cast<std::int16_t>(std::lround(x * static_cast<double>(kNormalScale)))));
        };
        view.normal[view.at(u, v)] = part(n.x) | part(n.y) << 16;
      }
    for (int i = 1; i < DepthPyramid::kLevels; ++i) {
      const ImageView<float>&fine = depth.levels[i - 1].z, &coarse = depth.levels[i].z;
      halve_depth(fine.data, fine.width, coarse.data, coarse.width, coarse.height);
    }
  }
  DepthPyramid depth;
  ModelMaps view;
  BoundMemory memory;
};

inline const Wall kCorner[] = {{{0, -1, 0}, -0.6}, {{0.6, 0, -0.8}, -2.0}, {{-0.8, 0, -0.6}, -1.8}};
inline const Wall kFlatWall[] = {{{0, 0, -1}, -1.5}};

}  // namespace st::test
