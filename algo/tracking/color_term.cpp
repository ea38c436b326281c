#include "algo/tracking/color_term.hpp"

#include <cmath>

#include "algo/tracking/color_kernel.hpp"

namespace st {
namespace {

// A gain, an offset and a residual's scale are three numbers: a share of the points gives them well enough.
constexpr std::size_t kFitPoints = 1000;

// The present and the model's luminance of those points that have both.
struct LuminancePairs {
  static constexpr std::size_t kMost = 2 * kFitPoints;  // a prefix is at most so much longer than wanted
  float present[kMost + PointTable::kPadding], model[kMost];
  int count = 0;
};

void collect(const ColorLook& look, const ColorKernel& kernel, LuminancePairs& pairs) {
  ColorKernel k = kernel;
  const int share = static_cast<int>(look.points.prefix(kFitPoints));
  if (share < k.count) k.count = share;
  sample_luminance(k, pairs.present);
  for (int i = 0; i < k.count; ++i) {
    if (pairs.present[i] < 0) continue;
    pairs.present[pairs.count] = pairs.present[i];
    pairs.model[pairs.count++] = look.points.luminance[static_cast<std::size_t>(i)];
  }
}

ColorKernel kernel_of(const ColorLook& look) {
  ColorKernel k{};
  k.x = look.points.x.data();
  k.y = look.points.y.data();
  k.z = look.points.z.data();
  k.luminance = look.points.luminance.data();
  k.count = static_cast<int>(look.count);
  const ColorFrame& frame = look.frame;
  k.frame = frame.pixels.data();
  k.width = frame.roi.width();
  k.height = frame.roi.height();
  k.fx = frame.camera.fx;
  k.fy = frame.camera.fy;
  k.cx = frame.camera.cx - static_cast<float>(frame.roi.u0);
  k.cy = frame.camera.cy - static_cast<float>(frame.roi.v0);
  const PoseF then = to_float(look.then);
  for (int i = 0; i < 9; ++i) k.to_then[i] = then.R.m[i], k.to_color[i] = frame.T_color_depth.R.m[i];
  for (int i = 0; i < 3; ++i) k.then_at[i] = then.t[i], k.color_at[i] = frame.T_color_depth.t[i];
  return k;
}

// Seen, or at least nothing known to stand before it or to lie behind it.
bool may_be_seen(ImageView<const float> depth_z, const Pinhole& camera, const Vec3f& p, float gate_m) {
  if (!(p.z > 0.1f)) return false;
  const Pinhole::Pixel at = camera.pixel_of(p);
  if (!depth_z.contains(at.u, at.v)) return true;  // the colour camera may look farther
  const float z = depth_z(at.u, at.v);
  return !(z > 0) || std::fabs(z - p.z) < gate_m + 3.0f * depth_sigma_m(p.z);
}

}  // namespace

void collect_color_points(const ViewTable& view, const Pinhole& camera, ImageView<const float> depth_z,
                          const Pose& D, const ColorTermOptions& options, std::size_t most,
                          PointTable& points) {
  const PoseF now = to_float(D);
  const Rect& box = view.roi;
  const auto for_each = [&](auto&& with) {
    for (int v = box.v0; v < box.v1; ++v)
      for (int u = box.u0; u < box.u1; ++u) {
        const ViewPixel& pixel = view.at(u, v);
        if (pixel.luminance == kNoColor) continue;
        const Vec3f p = camera.ray(static_cast<float>(u), static_cast<float>(v)) * pixel.z;
        if (may_be_seen(depth_z, camera, now * p, options.gate_m)) with(p, pixel);
      }
  };
  std::size_t all = 0;
  for_each([&](const Vec3f&, const ViewPixel&) { ++all; });
  points.begin(all, most);
  std::size_t seen = 0, kept = 0;
  for_each([&](const Vec3f& p, const ViewPixel& pixel) {
    if (kept == points.count || seen++ != points.source(kept)) return;
    points.put(kept++, p, static_cast<float>(pixel.luminance) / kLuminanceScale);
  });
}

ColorGain fit_color_gain(const ColorLook& look) {
  const ColorKernel k = kernel_of(look);
  LuminancePairs pairs;
  collect(look, k, pairs);
  if (pairs.count < 30) return {};
  ColorGain fit;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int i = 0; i < pairs.count; ++i) {
      const double x = pairs.model[i], y = pairs.present[i];
      const double e = y - (fit.gain * x + fit.offset);
      const double w = round == 0 ? 1.0 : 1.0 / (1.0 + e * e / 400.0);  // 20 grey levels
      n += w, sx += w * x, sy += w * y, sxx += w * x * x, sxy += w * x * y;
    }
    if (n < 30) return {};
    const double spread = sxx - sx * sx / n;
    // A gain far from one is a wrong fit, not an exposure: cameras change it by a little from frame to frame.
    double gain = spread > n * 25.0 ? (sxy - sx * sy / n) / spread : 1.0;
    gain = gain < 0.5 ? 0.5 : gain > 2.0 ? 2.0 : gain;
    fit.gain = static_cast<float>(gain);
    fit.offset = static_cast<float>((sy - gain * sx) / n);
  }
  return fit;
}

ColorTermResult add_color_term(const ColorLook& look, const Vec3& pivot, ColorGain gain,
                               const double (&shift_px)[2], const ColorTermOptions& options,
                               NormalEquations& into) {
  ColorKernel k = kernel_of(look);
  for (int i = 0; i < 3; ++i) k.pivot[i] = static_cast<float>(pivot[i]);
  k.gain = gain.gain;
  k.offset = gain.offset;
  k.shift_u = static_cast<float>(shift_px[0]);
  k.shift_v = static_cast<float>(shift_px[1]);

  // The scale of the residuals by their mean size (1.25 makes it sigma for a Gaussian).
  LuminancePairs pairs;
  collect(look, k, pairs);
  ColorTermResult result;
  if (pairs.count < 10) return result;
  float size_sum = 0;
  for (int i = 0; i < pairs.count; ++i) {
    const float size = std::fabs(pairs.present[i] - gain.gain * pairs.model[i] - gain.offset);
    size_sum += size < 60.0f ? size : 60.0f;
  }
  const float sigma = 1.25f * size_sum / static_cast<float>(pairs.count);
  result.sigma = sigma < 4.0f ? 4.0f : sigma;

  const float information = look.points.thinning(look.count) / options.correlated_pixels;
  k.weight = (information < 1.0f ? information : 1.0f) / (result.sigma * result.sigma);
  k.least_gradient2 = options.least_gradient * options.least_gradient;
  k.per_cut2 = 1.0f / (9.0f * result.sigma * result.sigma);
  accumulate_color(k);
  into.add_sums(k.triangle, k.gradient, NormalEquations::kSize);
  result.used = k.used;
  return result;
}

}  // namespace st
