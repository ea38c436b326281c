#include "algo/recognition/scale_space.hpp"

#include "algo/core/scalar_math.hpp"
#include "algo/recognition/blur_kernel.hpp"

namespace st {
namespace {

// Blurs `from` along one axis into `to`; beyond the edge the last value goes on.
void blur_along(const Grid& from, const Grid& to, int axis, float sigma, std::span<float> drawn_out) {
  float taps[kMostTaps + 1];
  const int radius = gaussian_taps(sigma, taps), n = from.side;
  const float* rows[2 * kMostTaps + 1];
  const auto clamped = [n](int i) { return i < 0 ? 0 : i < n ? i : n - 1; };
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      const float* const row = &from(0, y, z);
      if (axis == 0) {
        for (int x = -radius; x < n + radius; ++x)
          drawn_out[static_cast<std::size_t>(x + radius)] = row[clamped(x)];
        for (int k = 0; k <= 2 * radius; ++k) rows[k] = &drawn_out[static_cast<std::size_t>(k)];
      } else {
        for (int k = -radius; k <= radius; ++k)
          rows[k + radius] = axis == 1 ? &from(0, clamped(y + k), z) : &from(0, y, clamped(z + k));
      }
      blur_row(rows + radius, taps, radius, static_cast<std::size_t>(n), &to(0, y, z));
    }
  }
}

void take_every_second(const Grid& from, const Grid& to) {
  for (int z = 0; z < to.side; ++z)
    for (int y = 0; y < to.side; ++y)
      for (int x = 0; x < to.side; ++x) to(x, y, z) = from(2 * x, 2 * y, 2 * z);
}

}  // namespace

int gaussian_taps(float sigma, float* taps) {
  int radius = static_cast<int>(3.0f * sigma + 0.999f);
  if (radius > kMostTaps) radius = kMostTaps;
  double sum = 0;
  double exact[kMostTaps + 1];
  for (int k = 0; k <= radius; ++k) {
    exact[k] = exponential(-0.5 * k * k / (static_cast<double>(sigma) * static_cast<double>(sigma)));
    sum += k == 0 ? exact[k] : 2 * exact[k];
  }
  for (int k = 0; k <= radius; ++k) taps[k] = static_cast<float>(exact[k] / sum);
  return radius;
}

float ScaleSpace::sigma_of(float level) {
  constexpr double kLn2 = 0.69314718055994530942;
  return kFirstSigma * static_cast<float>(exponential(kLn2 * static_cast<double>(level) / kScalesPerOctave));
}

void ScaleSpace::bind(Bump& memory, int side) {
  octaves = 0;
  int s = side;
  for (; s >= kSmallestOctave && octaves < kMaxOctaves; s /= 2, ++octaves)
    for (Grid& level : levels[octaves]) {
      level.side = s;
      level.values = memory.take<float>(level.count());
    }
  rows = memory.take<float>(static_cast<std::size_t>(side) + 2 * kMostTaps);
  const auto n = static_cast<std::size_t>(side);
  pass = memory.take<float>(n * n * n);
}

void ScaleSpace::blur_pass(const Grid& input, int octave, int level, int axis) {
  Grid& to = levels[octave][level];
  if (level == 0 && octave > 0) {  // blurred already
    if (axis != 0) return;
    const Grid& from = levels[octave - 1][kScalesPerOctave];
    to.voxel_m = 2 * from.voxel_m;
    to.origin_m = from.origin_m;
    take_every_second(from, to);
    return;
  }
  const Grid& from = level == 0 ? input : levels[octave][level - 1];
  to.voxel_m = from.voxel_m;
  to.origin_m = from.origin_m;
  const float before = level == 0 ? kNominalSigma : sigma_of(static_cast<float>(level - 1));
  const float after = sigma_of(static_cast<float>(level));
  const float sigma = std::sqrt(after * after - before * before);
  Grid between = to;
  between.values = pass;
  // Into the level, to the work memory, and back: what a pass reads is never what it writes.
  if (axis == 0) blur_along(from, to, 0, sigma, rows);
  if (axis == 1) blur_along(to, between, 1, sigma, rows);
  if (axis == 2) blur_along(between, to, 2, sigma, rows);
}

}  // namespace st
