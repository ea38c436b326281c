#include "algo/segmentation/segment.hpp"

#include <cmath>

namespace st {
namespace {

constexpr float kReleasedShare = 0.3f;

// Height in metres below which `share` of the counted pixels lie.
float quantile(const std::uint32_t* bins, int count, std::uint32_t total, float share) {
  const auto rank = static_cast<std::uint32_t>(share * static_cast<float>(total));
  std::uint32_t seen = 0;
  for (int i = 0; i < count; ++i) {
    seen += bins[i];
    if (seen > rank) return (static_cast<float>(i - SegmentSums::kBinsBelowFloor) + 0.5f) * 0.01f;
  }
  return 0;
}

// The largest eigenvalue of a symmetric 3x3 matrix by power iteration.
double largest_eigenvalue(const Mat3& m) {
  Vec3 x{0.6, 0.5, 0.62};
  double value = 0;
  for (int i = 0; i < 24; ++i) {
    const Vec3 y = m * x;
    value = norm(y);
    if (!(value > 0)) return 0;
    x = y * (1.0 / value);
  }
  return value;
}

}  // namespace

bool is_cut(const Rect& box, const Rect& view) {
  constexpr int kRagged = 3;  // pixels: depth images end unevenly
  return box.u0 < view.u0 + kRagged || box.v0 < view.v0 + kRagged || box.u1 > view.u1 - kRagged ||
         box.v1 > view.v1 - kRagged;
}

Segment describe(const SegmentSums& sums, float area_cm2, bool has_height, const Rect& view) {
  Segment s;
  const double n = 1.0 / sums.measured;
  const Vec3 mean{sums.x * n, sums.y * n, sums.z * n};
  const double xy = sums.xy * n - mean.x * mean.y, xz = sums.xz * n - mean.x * mean.z;
  const double yz = sums.yz * n - mean.y * mean.z;
  const Mat3 spread{{sums.xx * n - mean.x * mean.x, xy, xz, xy, sums.yy * n - mean.y * mean.y, yz, xz, yz,
                     sums.zz * n - mean.z * mean.z}};
  s.box = sums.box;
  s.pixels = sums.pixels;
  s.area_cm2 = area_cm2;
  s.centroid_m = to_float(mean);
  s.extent_m =
      static_cast<float>(4.0 * std::sqrt(largest_eigenvalue(spread)));  // a disc's diameter is 4 sigma
  s.mean_code = static_cast<float>(sums.code * n);
  s.has_height = has_height;
  if (s.has_height) {
    const auto total = static_cast<std::uint32_t>(sums.measured);
    s.bottom_m = quantile(sums.heights, SegmentSums::kHeightBins, total, 0.02f);
    s.top_m = quantile(sums.heights, SegmentSums::kHeightBins, total, 0.98f);
  }
  s.touches_border = is_cut(sums.box, view);
  s.unknown_share = static_cast<float>(sums.unknown) / static_cast<float>(sums.pixels);
  s.from_background = static_cast<float>(sums.released) > kReleasedShare * static_cast<float>(sums.measured);
  return s;
}

}  // namespace st
