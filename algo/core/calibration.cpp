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

DisparityCorrection::Around DisparityCorrection::around(double u, double v, int width, int height) const {
  const double x = u * (columns - 1) / (width - 1), y = v * (rows - 1) / (height - 1);
  const int i = x < 0 ? 0 : x < columns - 2 ? static_cast<int>(x) : columns - 2;
  const int j = y < 0 ? 0 : y < rows - 2 ? static_cast<int>(y) : rows - 2;
  const double fx = x - i, fy = y - j;
  const int first = j * columns + i;
  return {{first, first + 1, first + columns, first + columns + 1},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

double DisparityCorrection::at(double u, double v, int width, int height) const {
  if (empty()) return 0;
  const Around nodes = around(u, v, width, height);
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += nodes.weight[i] * static_cast<double>(steps[nodes.node[i]]);
  return sum;
}

}  // namespace st
