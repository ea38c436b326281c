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
  float present[kMost], model[kMost + PointTable::kPadding];
  int count = 0;
};

void collect(const PointTable& points, const ColorKernel& kernel, LuminancePairs& pairs) {
  ColorKernel k = kernel;
  const int share = static_cast<int>(points.prefix(kFitPoints));
  if (share < k.pairing.count) k.pairing.count = share;
  sample_luminance(k, pairs.model);
  for (int i = 0; i < k.pairing.count; ++i) {
    if (pairs.model[i] < 0) continue;
    pairs.present[pairs.count] = points.luminance[static_cast<std::size_t>(i)];
    pairs.model[pairs.count++] = pairs.model[i];
  }
}

}  // namespace

ColorGain fit_color_gain(const PointTable& points, std::size_t count, const ViewTable& view,
                         const Pinhole& camera, const Pose& D, const ColorTermOptions& options) {
  ColorKernel k{};
  k.pairing = pairing_of(points, count, view, camera, D, {});
  k.gate_m = options.gate_m;
  LuminancePairs pairs;
  collect(points, k, pairs);
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

ColorTermResult add_color_term(const PointTable& points, std::size_t count, const ViewTable& view,
                               const Pinhole& camera, const Pose& D, const Vec3& pivot, ColorGain gain,
                               const double (&shift_px)[2], const ColorTermOptions& options,
                               NormalEquations& into) {
  ColorKernel k{};
  k.pairing = pairing_of(points, count, view, camera, D, pivot);
  k.gate_m = options.gate_m;
  k.gain = gain.gain;
  k.offset = gain.offset;
  k.shift_u = static_cast<float>(shift_px[0]);
  k.shift_v = static_cast<float>(shift_px[1]);

  // The scale of the residuals by their mean size (1.25 makes it sigma for a Gaussian).
  LuminancePairs pairs;
  collect(points, k, pairs);
  ColorTermResult result;
  if (pairs.count < 10) return result;
  float size_sum = 0;
  for (int i = 0; i < pairs.count; ++i) {
    const float size = std::fabs(pairs.present[i] - gain.gain * pairs.model[i] - gain.offset);
    size_sum += size < 60.0f ? size : 60.0f;
  }
  const float sigma = 1.25f * size_sum / static_cast<float>(pairs.count);
  result.sigma = sigma < 4.0f ? 4.0f : sigma;

  const float information = points.thinning(count) / options.correlated_pixels;
  k.weight = (information < 1.0f ? information : 1.0f) / (result.sigma * result.sigma);
  k.least_gradient2 = options.least_gradient * options.least_gradient;
  k.per_cut2 = 1.0f / (9.0f * result.sigma * result.sigma);
  accumulate_color(k);
  into.add_sums(k.triangle, k.gradient, NormalEquations::kSize);
  result.used = k.used;
  return result;
}

}  // namespace st
