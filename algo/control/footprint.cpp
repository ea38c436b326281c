#include "algo/control/footprint.hpp"

#include <algorithm>
#include <cmath>

#include "algo/control/circle_fit.hpp"
#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr int kSectors = 72;
constexpr int kBands = 6;

struct Outline {
  Point2 points[kSectors];
  int count = 0;
};

// The outermost vertex of each sector about `centre`, within the band of heights.
Outline outline_about(std::span<const MeshVertex> vertices, const Point2& centre, double z0, double z1) {
  double far2[kSectors] = {};
  Point2 at[kSectors];
  for (const MeshVertex& vertex : vertices) {
    const Vec3 p = to_double(vertex.position);
    if (p.z < z0 || p.z > z1) continue;
    const double dx = p.x - centre.x_m, dy = p.y - centre.y_m, d2 = dx * dx + dy * dy;
    const double turns = (arc_tan2(dy, dx) + kPi) / (2 * kPi);
    const int sector = std::clamp(static_cast<int>(turns * kSectors), 0, kSectors - 1);
    if (d2 > far2[sector]) far2[sector] = d2, at[sector] = {p.x, p.y};
  }
  Outline outline;
  for (int i = 0; i < kSectors; ++i)
    if (far2[i] > 0) outline.points[outline.count++] = at[i];
  return outline;
}

struct Extent {
  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9, z0 = 1e9, z1 = -1e9;

  explicit Extent(std::span<const MeshVertex> vertices) {
    for (const MeshVertex& vertex : vertices) {
      const Vec3 p = to_double(vertex.position);
      x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
      y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
      z0 = std::min(z0, p.z), z1 = std::max(z1, p.z);
    }
  }
  Point2 middle() const { return {0.5 * (x0 + x1), 0.5 * (y0 + y1)}; }
};

struct Round {
  CircleFit circle;
  double share = 0;  // of all sectors: on the circle
};

// A circle through the outline that may have a bumper, a cable or a missing side.
Round fit_round(std::span<const MeshVertex> vertices, Point2 centre, double z0, double z1) {
  constexpr int kRounds = 5;
  constexpr double kOff = 0.03;  // of the radius
  Round best;
  for (int round = 0; round < kRounds; ++round) {
    const Outline outline = outline_about(vertices, centre, z0, z1);
    Point2 on[kSectors];
    std::size_t count = 0;
    for (int i = 0; i < outline.count; ++i) {
      const Point2& p = outline.points[i];
      const double d = std::sqrt((p.x_m - centre.x_m) * (p.x_m - centre.x_m) +
                                 (p.y_m - centre.y_m) * (p.y_m - centre.y_m));
      if (round == 0 || std::fabs(d - best.circle.radius_m) <= kOff * best.circle.radius_m) on[count++] = p;
    }
    const CircleFit fit = fit_circle({on, count});
    if (!fit.valid) return {};
    best = {fit, static_cast<double>(count) / kSectors};
    centre = {fit.x_m, fit.y_m};
  }
  return best;
}

// The point that lies in the middle of the extents in all directions, and how far from it they leave that
// middle.
BasePrior symmetric_prior(std::span<const MeshVertex> vertices, const Extent& extent) {
  constexpr int kDirections = 36;
  double xx = 0, xy = 0, yy = 0, gx = 0, gy = 0, widest = 0;
  double middle[kDirections];
  for (int i = 0; i < kDirections; ++i) {
    const SinCos d = sin_cos(kPi * i / kDirections);
    double low = 1e9, high = -1e9;
    for (const MeshVertex& vertex : vertices) {
      const double s =
          d.cos * static_cast<double>(vertex.position.x) + d.sin * static_cast<double>(vertex.position.y);
      low = std::min(low, s), high = std::max(high, s);
    }
    middle[i] = 0.5 * (low + high);
    widest = std::max(widest, high - low);
    xx += d.cos * d.cos, xy += d.cos * d.sin, yy += d.sin * d.sin;
    gx += d.cos * middle[i], gy += d.sin * middle[i];
  }
  const double det = xx * yy - xy * xy;
  const Point2 centre =
      det > 0 ? Point2{(yy * gx - xy * gy) / det, (xx * gy - xy * gx) / det} : extent.middle();
  double square = 0;
  for (int i = 0; i < kDirections; ++i) {
    const SinCos d = sin_cos(kPi * i / kDirections);
    const double off = middle[i] - d.cos * centre.x_m - d.sin * centre.y_m;
    square += off * off / kDirections;
  }
  constexpr double kLeastLateralM = 0.006, kForwardShare = 0.15;  // axles lie within the middle third or so
  return {centre.x_m, centre.y_m, kForwardShare * widest, kLeastLateralM + 2.0 * std::sqrt(square)};
}

}  // namespace

BasePrior footprint_prior(std::span<const MeshVertex> vertices) {
  constexpr std::size_t kLeastVertices = 200;
  if (vertices.size() < kLeastVertices) return {};
  const Extent extent(vertices);
  const double height = extent.z1 - extent.z0;
  Round best = fit_round(vertices, extent.middle(), extent.z0, extent.z1);
  // What stands on the robot must not hide its round body: look at slices of its height, too.
  for (int band = 0; band < kBands; ++band) {
    const Round slice = fit_round(vertices, extent.middle(), extent.z0 + height * band / kBands,
                                  extent.z0 + height * (band + 1) / kBands);
    if (slice.share > best.share) best = slice;
  }
  constexpr double kLeastShare = 0.8, kSurfaceM = 0.003;
  if (best.share < kLeastShare) return symmetric_prior(vertices, extent);
  const double sigma_m = kSurfaceM + best.circle.rms_m / std::sqrt(best.share * kSectors / 3.0);
  return {best.circle.x_m, best.circle.y_m, sigma_m, sigma_m};
}

}  // namespace st
