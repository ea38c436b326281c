#include "algo/recognition/volume_fit.hpp"

#include "algo/core/scalar_math.hpp"
#include "algo/core/solve.hpp"
#include "algo/volume/surface_points.hpp"

namespace st {
namespace {

constexpr double kResidualScale_m = 0.006, kHeightSigma_m = 0.004;
constexpr int kLeastColoured = 60;

float luminance_of(const ColorSample& c) { return 0.299f * c.r + 0.587f * c.g + 0.114f * c.b; }

// One step in x, y, z and the turn about the points' middle.
bool improve(const Volume& model, std::span<const SurfacePoint> seen, const Vec3& start_t, Pose& T) {
  double A[16]{}, b[4]{};
  const PoseF Tf = to_float(T);
  Vec3f middle{};
  for (const SurfacePoint& s : seen) middle += s.p * (1.0f / static_cast<float>(seen.size()));
  const Vec3f pivot = Tf * middle;
  int used = 0;
  for (const SurfacePoint& s : seen) {
    const Vec3f q = Tf * s.p;
    const SdfSample at = sample(model, q);
    if (!at.valid) continue;
    ++used;
    const double r = static_cast<double>(at.sdf_m) / kResidualScale_m;
    const double w = 1 / ((1 + r * r) * (1 + r * r));  // Geman-McClure
    const Vec3f arm = q - pivot;
    const double J[4] = {static_cast<double>(at.gradient.x), static_cast<double>(at.gradient.y),
                         static_cast<double>(at.gradient.z),
                         static_cast<double>(at.gradient.y * arm.x - at.gradient.x * arm.y)};
    for (int i = 0; i < 4; ++i) {
      b[i] -= w * J[i] * static_cast<double>(at.sdf_m);
      for (int j = 0; j < 4; ++j) A[4 * i + j] += w * J[i] * J[j];
    }
  }
  if (used < 20) return false;
  // Both stand on the floor.
  const double floor = 0.05 * used * kResidualScale_m * kResidualScale_m / (kHeightSigma_m * kHeightSigma_m);
  A[10] += floor;
  b[2] -= floor * (T.t.z - start_t.z);
  for (int i = 0; i < 4; ++i) A[5 * i] += 1e-6 * used;
  double step[4];
  if (!solve_spd(A, b, step, 4)) return false;
  T = moved_about(T, {{step[0], step[1], step[2]}, {0, 0, step[3]}}, to_double(pivot));
  return true;
}

struct Correlation {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  void add(double x, double y) { ++n, a += x, b += y, aa += x * x, bb += y * y, ab += x * y; }
  double value() const {
    const double va = aa - a * a / n, vb = bb - b * b / n;
    return va > 1e-9 && vb > 1e-9 ? (ab - a * b / n) / std::sqrt(va * vb) : 0;
  }
};

struct Range {
  float low = 0, high = 0;
};

// Without the outermost 2 % on each side; by counting in bins, linearly within the last one.
Range trimmed_range(std::span<const SurfacePoint> points, const Vec3f& along) {
  constexpr int kBins = 256;
  float low = 1e9f, high = -1e9f;
  for (const SurfacePoint& s : points) {
    const float x = dot(s.p, along);
    low = x < low ? x : low;
    high = x > high ? x : high;
  }
  if (!(high > low)) return {low, high};
  const float width = (high - low) / kBins;
  int bins[kBins]{};
  for (const SurfacePoint& s : points) {
    const int i = static_cast<int>((dot(s.p, along) - low) / width);
    ++bins[i < kBins ? i : kBins - 1];
  }
  const int trim = static_cast<int>(points.size() / 50);
  const auto inwards = [&](bool up) {
    for (int k = 0, sum = 0; k < kBins; ++k) {
      const int count = bins[up ? k : kBins - 1 - k];
      if (sum + count > trim)
        return (static_cast<float>(k) + static_cast<float>(trim - sum) / static_cast<float>(count)) * width;
      sum += count;
    }
    return 0.0f;
  };
  return {low + inwards(true), high - inwards(false)};
}

}  // namespace

std::size_t sample_surface(const Volume& volume, std::span<SurfacePoint> out, std::span<Vec3f> scratch) {
  const std::size_t n = surface_points(volume, scratch.first(out.size()));
  for (std::size_t i = 0; i < n; ++i) {
    const ColorSample color = sample_color(volume, scratch[i]);
    out[i] = {scratch[i], color.valid ? luminance_of(color) : -1.0f};
  }
  return n;
}

float VolumeFit::score() const {
  const float print = colored < kLeastColoured ? 0.5f : likeness > 0 ? likeness : 0.0f;
  return explained * (0.7f + 0.3f * print);
}

VolumeFit fit_to_volume(const Volume& model, std::span<const SurfacePoint> seen, const Pose& start,
                        int iterations) {
  VolumeFit fit;
  fit.T_model_seen = start;
  for (int i = 0; i < iterations; ++i)
    if (!improve(model, seen, start.t, fit.T_model_seen)) return fit;
  fit.T_model_seen.R = orthonormalized(fit.T_model_seen.R);
  const PoseF T = to_float(fit.T_model_seen);
  Correlation print;
  int on_surface = 0;
  for (const SurfacePoint& s : seen) {
    const Vec3f q = T * s.p;
    const SdfSample at = sample(model, q);
    if (!at.valid || std::fabs(at.sdf_m) > kFitTolerance_m) continue;
    ++on_surface;
    const ColorSample color = sample_color(model, q);
    if (color.valid && s.luminance >= 0)
      print.add(static_cast<double>(luminance_of(color)), static_cast<double>(s.luminance));
  }
  if (on_surface == 0) return fit;
  fit.explained = static_cast<float>(on_surface) / static_cast<float>(seen.size());
  fit.colored = static_cast<int>(print.n);
  fit.likeness = print.n > 2 ? static_cast<float>(print.value()) : 0.0f;
  return fit;
}

Silhouette silhouette(std::span<const SurfacePoint> points, const Vec3f& towards) {
  const Range across = trimmed_range(points, {-towards.y, towards.x, 0});
  return {trimmed_range(points, towards).high, across.low, across.high};
}

Bounds surface_bounds(std::span<const SurfacePoint> points) {
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3f along{};
    along[axis] = 1;
    const Range range = trimmed_range(points, along);
    bounds.low[axis] = static_cast<double>(range.low);
    bounds.high[axis] = static_cast<double>(range.high);
  }
  return bounds;
}

bool start_from_silhouette(std::span<const SurfacePoint> model, std::span<const SurfacePoint> seen,
                           const Vec3f& towards, double yaw_rad, Pose& T_model_seen) {
  constexpr float kMostShare = 0.35f, kMost_m = 0.03f;
  const Mat3 R = rotation_z(yaw_rad);
  const Vec3f turned = to_float(R * to_double(towards)), side{-turned.y, turned.x, 0};
  const Silhouette a = silhouette(seen, towards), b = silhouette(model, turned);
  if (std::fabs(a.width() - b.width()) > kMostShare * b.width() + kMost_m) return false;
  const Vec3f t = turned * (b.nearest - a.nearest) + side * (b.middle() - a.middle());
  T_model_seen = {R, to_double(t)};
  return true;
}

}  // namespace st
