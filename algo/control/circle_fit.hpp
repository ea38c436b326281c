// The circle through points in the plane.
#pragma once

#include <span>

namespace st {

struct Point2 {
  double x_m = 0, y_m = 0;
};

struct CircleFit {
  bool valid = false;
  double x_m = 0, y_m = 0, radius_m = 0;  // centre and radius
  double rms_m = 0;                       // of the distances to the circle
};

// Least squares of the distances (algebraic start, then Gauss-Newton). Invalid for fewer than three points or
// points on a line.
CircleFit fit_circle(std::span<const Point2> points);

}  // namespace st
