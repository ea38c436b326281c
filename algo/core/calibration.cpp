#include "algo/core/calibration.hpp"

namespace st {

Normalized distort(const Intrinsics& camera, Normalized p) {
  const double* k = camera.k;
  const double r2 = p.x * p.x + p.y * p.y;
  const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  return {p.x * radial + 2 * k[2] * p.x * p.y + k[3] * (r2 + 2 * p.x * p.x),
          p.y * radial + k[2] * (r2 + 2 * p.y * p.y) + 2 * k[3] * p.x * p.y};
}

Normalized undistort(const Intrinsics& camera, Normalized d) {
  Normalized p = d;
  for (int i = 0; i < 20; ++i) {
    const Normalized e = distort(camera, p);
    p = {p.x + (d.x - e.x), p.y + (d.y - e.y)};
  }
  return p;
}

}  // namespace st
