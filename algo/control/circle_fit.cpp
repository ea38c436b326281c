#include "algo/control/circle_fit.hpp"

#include <cmath>
#include <cstddef>

#include "algo/control/symmetric3.hpp"

namespace st {
namespace {

Point2 mean_of(std::span<const Point2> points) {
  Point2 mean;
  for (const Point2& p : points) mean.x_m += p.x_m, mean.y_m += p.y_m;
  const double n = static_cast<double>(points.size());
  return {mean.x_m / n, mean.y_m / n};
}

// Kasa: x^2 + y^2 = 2 a x + 2 b y + c is linear. About the mean, so that it is well conditioned.
CircleFit algebraic(std::span<const Point2> points) {
  const Point2 mean = mean_of(points);
  Symmetric3 H;
  double g[3] = {0, 0, 0}, size2 = 0;
  for (const Point2& p : points) {
    const double x = p.x_m - mean.x_m, y = p.y_m - mean.y_m;
    const double row[3] = {2 * x, 2 * y, 1};
    H.add_outer(row, 1.0);
    for (int i = 0; i < 3; ++i) g[i] += row[i] * (x * x + y * y);
    size2 += x * x + y * y;
  }
  double s[3];
  if (!H.solve(g, s)) return {};
  const double radius = std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2]);
  // Points on a line have their circle at infinity.
  constexpr double kLargestRatio = 1e3;
  const double size = std::sqrt(size2 / static_cast<double>(points.size()));
  if (!(radius > 0) || radius > kLargestRatio * size) return {};
  return {true, s[0] + mean.x_m, s[1] + mean.y_m, radius, 0};
}

}  // namespace

CircleFit fit_circle(std::span<const Point2> points) {
  if (points.size() < 3) return {};
  CircleFit fit = algebraic(points);
  constexpr int kSteps = 10;
  for (int step = 0; fit.valid && step < kSteps; ++step) {
    Symmetric3 H;
    double g[3] = {0, 0, 0}, square = 0;
    for (const Point2& p : points) {
      const double dx = p.x_m - fit.x_m, dy = p.y_m - fit.y_m, d = std::sqrt(dx * dx + dy * dy);
      if (d <= 0) continue;
      const double row[3] = {dx / d, dy / d, 1}, r = d - fit.radius_m;
      H.add_outer(row, 1.0);
      for (int i = 0; i < 3; ++i) g[i] += row[i] * r;
      square += r * r;
    }
    fit.rms_m = std::sqrt(square / static_cast<double>(points.size()));
    double s[3];
    if (!H.solve(g, s)) break;
    fit.x_m += s[0], fit.y_m += s[1], fit.radius_m += s[2];
  }
  return fit;
}

}  // namespace st
