#include "algo/tracking/image_box.hpp"

#include <algorithm>
#include <cmath>

namespace st {

Rect image_box(const Bounds& bounds, const Pose& T_camera_object, const Pinhole& camera, int margin_px) {
  if (bounds.empty()) return {};
  Rect box = Rect::nothing();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{corner & 1 ? bounds.high.x : bounds.low.x, corner & 2 ? bounds.high.y : bounds.low.y,
                 corner & 4 ? bounds.high.z : bounds.low.z};
    const Vec3 c = T_camera_object * p;
    if (c.z < 0.2) return {0, 0, camera.width, camera.height};
    // Clamped far outside of any image, so that the conversion to int is defined.
    const double u = std::max(-1e4, std::min(1e4, camera.fx * c.x / c.z + camera.cx));
    const double v = std::max(-1e4, std::min(1e4, camera.fy * c.y / c.z + camera.cy));
    box.include(static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)));
    box.include(static_cast<int>(std::ceil(u)), static_cast<int>(std::ceil(v)));
  }
  return box.grown(margin_px);
}

}  // namespace st
