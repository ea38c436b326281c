#include "algo/recognition/volume_fit.hpp"

#include "algo/core/scalar_math.hpp"
#include "algo/core/solve.hpp"
#include "algo/volume/surface_points.hpp"

namespace st {
namespace {

constexpr double kResidualScale_m = 0.006, kHeightSigma_m = 0.004;

// Every `stride`th of the points seen.
struct Subset {
  Subset(const SeenSurface& seen, int every)
      : points(seen.points), stride(static_cast<std::size_t>(every)), tolerance_m(seen.tolerance_m) {
    for (std::size_t i = 0; i < points.size(); i += stride) middle += points[i].p;
    middle = middle * (1.0f / static_cast<float>(count()));
  }
  std::size_t count() const { return (points.size() + stride - 1) / stride; }

  std::span<const SurfacePoint> points;
  std::size_t stride;
  float tolerance_m;
  Vec3f middle{};
};

// One step in x, y, z and the turn about the points' middle.
bool improve(const Volume& model, const Subset& seen, const Vec3& start_t, Pose& T) {
  double A[16]{}, b[4]{};
  const PoseF Tf = to_float(T);
  const Vec3f pivot = Tf * seen.middle;
  int used = 0;
  for (std::size_t k = 0; k < seen.points.size(); k += seen.stride) {
    const Vec3f q = Tf * seen.points[k].p;
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

// Correlation over all channels together, each about the mean of all: hue counts as well as print, and a
// brighter light changes nothing. What differs by no more than noise and shading is alike.
struct Correlation {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  void add(double x, double y) { ++n, a += x, b += y, aa += x * x, bb += y * y, ab += x * y; }
  void add(const ColorSample& x, const ColorSample& y) {
    add(static_cast<double>(x.r), static_cast<double>(y.r));
    add(static_cast<double>(x.g), static_cast<double>(y.g));
    add(static_cast<double>(x.b), static_cast<double>(y.b));
  }
  double value() const {
    constexpr double kNoise = 10.0 * 10.0;  // grey levels, squared
    if (n < 1) return 0;
    const double va = aa / n - a / n * (a / n), vb = bb / n - b / n * (b / n), cov = ab / n - a / n * (b / n);
    return (cov + kNoise) / std::sqrt((va + kNoise) * (vb + kNoise));
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

float skirt_m(float height_m) {
  constexpr float kMost_m = 0.04f, kMostShare = 0.35f;
  return height_m * kMostShare < kMost_m ? height_m * kMostShare : kMost_m;
}

SampledSurface sample_surface(const Volume& volume, std::span<SurfacePoint> out, std::span<Vec3f> scratch) {
  const std::size_t n = surface_points(volume, scratch.first(out.size()));
  if (n == 0) return {};
  for (std::size_t i = 0; i < n; ++i) out[i].p = scratch[i];
  const Range up = trimmed_range(out.first(n), {0, 0, 1});
  const float least_z = up.low + skirt_m(up.high - up.low);
  SampledSurface sampled;
  for (std::size_t i = 0; i < n; ++i) {
    if (scratch[i].z < least_z) continue;
    out[sampled.points++] = {scratch[i], sample_color(volume, scratch[i])};
  }
  const std::span<const SurfacePoint> kept = out.first(sampled.points);
  const Range along = trimmed_range(kept, {1, 0, 0}), across = trimmed_range(kept, {0, 1, 0});
  sampled.bounds.low = to_double(Vec3f{along.low, across.low, up.low});
  sampled.bounds.high = to_double(Vec3f{along.high, across.high, up.high});
  return sampled;
}

float VolumeFit::score() const {
  const float print = colored < kLeastColoured ? 0.5f : likeness > 0 ? likeness : 0.0f;
  return explained * (0.7f + 0.3f * print);
}

namespace {

VolumeFit measure(const Volume& model, const Subset& seen, const Pose& T_model_seen) {
  const float tolerance_m = seen.tolerance_m;
  VolumeFit fit;
  fit.T_model_seen = T_model_seen;
  const PoseF T = to_float(T_model_seen);
  Correlation print;
  int on_surface = 0;
  for (std::size_t i = 0; i < seen.points.size(); i += seen.stride) {
    const SurfacePoint& s = seen.points[i];
    const Vec3f q = T * s.p;
    const SdfSample at = sample(model, q);
    if (!at.valid || std::fabs(at.sdf_m) > tolerance_m) continue;
    ++on_surface;
    if (!s.color.valid) continue;
    const ColorSample color = sample_color(model, q);
    if (!color.valid) continue;
    print.add(color, s.color);
    ++fit.colored;
  }
  if (on_surface == 0) return fit;
  fit.explained = static_cast<float>(on_surface) / static_cast<float>(seen.count());
  fit.colored *= static_cast<int>(seen.stride);
  fit.likeness = fit.colored > 2 ? static_cast<float>(print.value()) : 0.0f;
  return fit;
}

}  // namespace

VolumeFit fit_to_volume(const Volume& model, const SeenSurface& seen, const Pose& start, int iterations,
                        int stride) {
  const Subset subset(seen, stride);
  VolumeFit fit;
  fit.T_model_seen = start;
  for (int i = 0; i < iterations; ++i)
    if (!improve(model, subset, start.t, fit.T_model_seen)) return fit;
  return measure(model, subset, {orthonormalized(fit.T_model_seen.R), fit.T_model_seen.t});
}

VolumeFit turn_to_print(const Volume& model, const SeenSurface& seen, const VolumeFit& fit, int steps,
                        double step_rad, int stride) {
  const Subset subset(seen, stride);
  VolumeFit best = fit;
  const Vec3 pivot = fit.T_model_seen * to_double(subset.middle);
  for (int i = -steps; i <= steps; ++i) {
    const Pose turned = moved_about(fit.T_model_seen, {{}, {0, 0, i * step_rad}}, pivot);
    const VolumeFit tried = measure(model, subset, turned);
    if (tried.score() > best.score()) best = tried;
  }
  return best;
}

Silhouette silhouette(std::span<const SurfacePoint> points, const Vec3f& towards) {
  const Range across = trimmed_range(points, {-towards.y, towards.x, 0});
  return {trimmed_range(points, towards).high, across.low, across.high};
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
