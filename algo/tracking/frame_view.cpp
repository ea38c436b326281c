#include "algo/tracking/frame_view.hpp"

#include <cmath>

#include "algo/depth/edge_step.hpp"
#include "algo/tracking/observe.hpp"

namespace st {
namespace {

// Least-squares plane z = a du + b dv + c over the window, in image coordinates: three sums suffice on a full
// grid, but windows have holes, so the normal equations are solved whole.
bool window_normal(ImageView<const float> depth_z, ImageView<const std::uint8_t> owners, std::uint8_t owner,
                   int u, int v, const Pinhole& camera, Vec3f& normal) {
  constexpr int kReach = 3;
  const float z0 = depth_z(u, v);
  float n = 0, su = 0, sv = 0, suu = 0, suv = 0, svv = 0, sz = 0, suz = 0, svz = 0;
  for (int dv = -kReach; dv <= kReach; ++dv) {
    for (int du = -kReach; du <= kReach; ++du) {
      if (!depth_z.contains(u + du, v + dv) || owners(u + du, v + dv) != owner) continue;
      const float z = depth_z(u + du, v + dv);
      if (!(z > 0) || std::fabs(z - z0) > edge_step_m(z0)) continue;
      const float x = static_cast<float>(du), y = static_cast<float>(dv), e = z - z0;
      n += 1, su += x, sv += y, suu += x * x, suv += x * y, svv += y * y, sz += e, suz += x * e, svz += y * e;
    }
  }
  if (n < 12) return false;
  const float cuu = suu - su * su / n, cuv = suv - su * sv / n, cvv = svv - sv * sv / n;
  const float cuz = suz - su * sz / n, cvz = svz - sv * sz / n;
  const float det = cuu * cvv - cuv * cuv;
  if (!(det > 1.0f)) return false;
  const float a = (cuz * cvv - cvz * cuv) / det, b = (cvz * cuu - cuz * cuv) / det;  // metres per pixel
  // Tangents of the surface (u, v) -> ray(u, v) z(u, v); their cross product points to the camera when dz is
  // small.
  const Vec3f ray = camera.ray(static_cast<float>(u), static_cast<float>(v));
  const Vec3f tu = ray * a + Vec3f{z0 / camera.fx, 0, 0}, tv = ray * b + Vec3f{0, z0 / camera.fy, 0};
  normal = normalized(cross(tv, tu));
  return normal.z < 0;
}

std::uint32_t pack_normal(const Vec3f& n) {
  const auto half = [](float x) {
    return static_cast<std::uint32_t>(
        static_cast<std::uint16_t>(static_cast<std::int16_t>(x * kNormalScale)));
  };
  return half(n.x) | half(n.y) << 16;
}

}  // namespace

void remember_frame(FrameViewMemory& memory, ImageView<const float> depth_z,
                    ImageView<const std::uint8_t> owners, std::uint8_t owner, Rect roi, const Pinhole& camera,
                    ImageView<const std::uint32_t> color, const Pose& T_camera_object) {
  ModelMaps& maps = memory.view.maps;
  maps.roi = roi.clipped(depth_z.width, depth_z.height);
  maps.stride = maps.roi.width();
  memory.surface_pixels = 0;
  for (int v = maps.roi.v0; v < maps.roi.v1; ++v) {
    for (int u = maps.roi.u0; u < maps.roi.u1; ++u) {
      const std::size_t at = maps.at(u, v);
      maps.z[at] = 0;
      Vec3f normal;
      if (owners(u, v) != owner || !(depth_z(u, v) > 0)) continue;
      if (!window_normal(depth_z, owners, owner, u, v, camera, normal)) continue;
      maps.z[at] = depth_z(u, v);
      maps.normal[at] = pack_normal(normal);
      maps.color[at] = color.empty() ? 0 : color(u, v);
      ++memory.surface_pixels;
    }
  }
  memory.view.T_camera_object = T_camera_object;
  memory.age = 0;
}

}  // namespace st
