#include "algo/recognition/descriptor.hpp"

#include "algo/core/scalar_math.hpp"
#include "algo/recognition/direction.hpp"

namespace st {
namespace {

// Trilinear gradient between voxels: central differences of the interpolated values. Zero outside.
Vec3f gradient_between(const Grid& level, const Vec3f& p) {
  const float last = static_cast<float>(level.side - 2);
  if (!(p.x >= 1 && p.y >= 1 && p.z >= 1 && p.x < last && p.y < last && p.z < last)) return {};
  const int x = static_cast<int>(p.x), y = static_cast<int>(p.y), z = static_cast<int>(p.z);
  const float fx = p.x - static_cast<float>(x), fy = p.y - static_cast<float>(y),
              fz = p.z - static_cast<float>(z);
  const auto n = static_cast<std::ptrdiff_t>(level.side);
  const std::ptrdiff_t strides[3] = {1, n, n * n};
  Vec3f g{};
  for (int i = 0; i < 8; ++i) {
    const int dx = i & 1, dy = i >> 1 & 1, dz = i >> 2;
    const float w = (dx != 0 ? fx : 1 - fx) * (dy != 0 ? fy : 1 - fy) * (dz != 0 ? fz : 1 - fz);
    const float* const at = &level.values[level.index(x + dx, y + dy, z + dz)];
    for (int axis = 0; axis < 3; ++axis) g[axis] += w * (at[strides[axis]] - *(at - strides[axis]));
  }
  return g * 0.5f;
}

// A value between two bins: the lower one and the share of the upper.
struct Split {
  int low;
  float upper;
};
Split split(float at) {
  const float down = std::floor(at);
  return {static_cast<int>(down), at - down};
}

struct SolidAngles {
  float weight[kElevationBins];  // by one over the solid angle; 1 on average

  SolidAngles() {
    double sum = 0, exact[kElevationBins];
    for (int e = 0; e < kElevationBins; ++e) {
      const double low = kPi * e / kElevationBins - kPi / 2, high = low + kPi / kElevationBins;
      exact[e] = 1 / (sin_cos(high).sin - sin_cos(low).sin);
      sum += exact[e];
    }
    for (int e = 0; e < kElevationBins; ++e) weight[e] = static_cast<float>(exact[e] * kElevationBins / sum);
  }
};

// Spreads one gradient over the cells and directions next to it.
void add(std::span<float> histogram, const SolidAngles& solid, const Vec3f& cell, const Vec3f& g,
         float weight) {
  const float azimuth = coarse_arc_tan2(g.y, g.x);
  const float elevation = coarse_arc_tan2(g.z, std::sqrt(g.x * g.x + g.y * g.y));
  // Bins' middles lie at azimuth 0, 45, ... and half a bin from the poles.
  constexpr float kPif = static_cast<float>(kPi);
  const Split a = split(azimuth * (kAzimuthBins / (2 * kPif)) + kAzimuthBins);
  const Split e = split((elevation + kPif / 2) * (kElevationBins / kPif) - 0.5f);
  const Split at[3] = {split(cell.x), split(cell.y), split(cell.z)};
  for (int i = 0; i < 8; ++i) {
    int c[3];
    float w = weight;
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = (i >> axis & 1) != 0;
      c[axis] = at[axis].low + (upper ? 1 : 0);
      w *= upper ? at[axis].upper : 1 - at[axis].upper;
      inside = inside && c[axis] >= 0 && c[axis] < kCellsPerAxis;
    }
    if (!inside) continue;
    const int bins = ((c[2] * kCellsPerAxis + c[1]) * kCellsPerAxis + c[0]) * kAzimuthBins * kElevationBins;
    for (int j = 0; j < 4; ++j) {
      const bool next_a = (j & 1) != 0, next_e = (j & 2) != 0;
      int bin_e = e.low + (next_e ? 1 : 0);
      bin_e = bin_e < 0 ? 0 : bin_e >= kElevationBins ? kElevationBins - 1 : bin_e;  // poles take it whole
      const int bin_a = (a.low + (next_a ? 1 : 0)) % kAzimuthBins;
      histogram[static_cast<std::size_t>(bins + bin_e * kAzimuthBins + bin_a)] +=
          w * (next_a ? a.upper : 1 - a.upper) * (next_e ? e.upper : 1 - e.upper) * solid.weight[bin_e];
    }
  }
}

void normalise(std::span<float> values) {
  float sum = 0;
  for (const float v : values) sum += v * v;
  if (!(sum > 0)) return;
  const float scale = 1 / std::sqrt(sum);
  for (float& v : values) v *= scale;
}

}  // namespace

void describe(const Grid& level, const Vec3f& voxel, float sigma, const Mat3f& R,
              std::span<float> histogram) {
  for (float& v : histogram) v = 0;
  const SolidAngles solid;
  const Mat3f to_frame = R.transposed();
  const float spacing = 2 * kHalfWidthSigmas * sigma / kSamplesPerAxis;
  constexpr float kMiddle = 0.5f * (kSamplesPerAxis - 1);
  constexpr float kCellsPerSample = static_cast<float>(kCellsPerAxis) / kSamplesPerAxis;
  float window[kSamplesPerAxis];  // Gaussian; its sigma is half the width
  for (int i = 0; i < kSamplesPerAxis; ++i) {
    const double off = (static_cast<double>(i) - static_cast<double>(kMiddle)) / (kSamplesPerAxis / 2.0);
    window[i] = static_cast<float>(exponential(-0.5 * off * off));
  }
  for (int k = 0; k < kSamplesPerAxis; ++k)
    for (int j = 0; j < kSamplesPerAxis; ++j)
      for (int i = 0; i < kSamplesPerAxis; ++i) {
        const Vec3f at{static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)};
        const Vec3f p = voxel + R * ((at - Vec3f{kMiddle, kMiddle, kMiddle}) * spacing);
        const Vec3f g = to_frame * gradient_between(level, p);
        const float length = norm(g);
        if (!(length > 1e-7f)) continue;
        const Vec3f cell = (at + Vec3f{0.5f, 0.5f, 0.5f}) * kCellsPerSample - Vec3f{0.5f, 0.5f, 0.5f};
        add(histogram, solid, cell, g, length * window[i] * window[j] * window[k]);
      }
  normalise(histogram);
  for (float& v : histogram) v = v > kLargestElement ? kLargestElement : v;
  normalise(histogram);
}

Descriptor to_bytes(std::span<const float> histogram) {
  Descriptor d{};
  for (std::size_t i = 0; i < histogram.size() && i < kDescriptorLength; ++i) {
    const float scaled = histogram[i] * kByteScale + 0.5f;
    d.bytes[i] = static_cast<std::uint8_t>(scaled < 255 ? scaled : 255);
  }
  return d;
}

}  // namespace st
