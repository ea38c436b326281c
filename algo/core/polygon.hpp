// Points in the plane and areas bounded by them.
#pragma once

#include <span>

namespace st {

struct PlanePoint {
  double x_m = 0, y_m = 0;
};

// Whether (x, y) lies inside, by counting the edges that a ray to +x crosses. Corners in order, either way
// round; the last is joined to the first.
inline bool is_inside(std::span<const PlanePoint> corners, double x_m, double y_m) {
  bool inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const PlanePoint &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if ((a.y_m > y_m) == (b.y_m > y_m)) continue;
    if (x_m < a.x_m + (y_m - a.y_m) / (b.y_m - a.y_m) * (b.x_m - a.x_m)) inside = !inside;
  }
  return inside;
}

}  // namespace st
