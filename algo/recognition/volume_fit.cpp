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
  double squares = 0;
  for (const SurfacePoint& s : seen) {
    const Vec3f q = T * s.p;
    const SdfSample at = sample(model, q);
    if (!at.valid || std::fabs(at.sdf_m) > kFitTolerance_m) continue;
    ++on_surface;
    squares += static_cast<double>(at.sdf_m * at.sdf_m);
    const ColorSample color = sample_color(model, q);
    if (color.valid && s.luminance >= 0)
      print.add(static_cast<double>(luminance_of(color)), static_cast<double>(s.luminance));
  }
  if (on_surface == 0) return fit;
  fit.explained = static_cast<float>(on_surface) / static_cast<float>(seen.size());
  fit.rms_m = static_cast<float>(std::sqrt(squares / on_surface));
  fit.colored = static_cast<int>(print.n);
  fit.likeness = print.n > 2 ? static_cast<float>(print.value()) : 0.0f;
  return fit;
}

Silhouette silhouette(std::span<const SurfacePoint> points, const Vec3f& towards) {
  constexpr int kBins = 128;
  constexpr float kReach_m = 1.5f;
  const Vec3f side{-towards.y, towards.x, 0};
  int depth[kBins]{}, across[kBins]{};
  const auto bin = [](float x) {
    const int i = static_cast<int>((x + kReach_m) / (2 * kReach_m) * kBins);
    return i < 0 ? 0 : i >= kBins ? kBins - 1 : i;
  };
  for (const SurfacePoint& s : points) ++depth[bin(dot(s.p, towards))], ++across[bin(dot(s.p, side))];
  const int trim = static_cast<int>(points.size() / 50);
  // Within the bin where the count passes the trim, linearly.
  const auto from_low = [&](const int(&bins)[kBins], bool up) {
    int sum = 0;
    for (int k = 0; k < kBins; ++k) {
      const int i = up ? k : kBins - 1 - k;
      if (sum + bins[i] > trim) {
        const float share = static_cast<float>(trim - sum) / static_cast<float>(bins[i]);
        const float edge = up ? static_cast<float>(i) + share : static_cast<float>(i + 1) - share;
        return edge * 2 * kReach_m / kBins - kReach_m;
      }
      sum += bins[i];
    }
    return 0.0f;
  };
  return {from_low(depth, false), from_low(across, true), from_low(across, false)};
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
