#include "algo/recognition/known_model.hpp"

#include <cmath>

#include "algo/tracking/recover.hpp"

namespace st {

ColorStats color_stats(const Volume& v) {
  const float near = 0.5f * v.voxel_m / v.truncation_m * kTsdfScale;
  double sum = 0, squares = 0, red = 0, green = 0;
  ColorStats stats;
  for (std::size_t i = 0; i < v.voxels(); ++i) {
    if (v.tsdf[i] == kUnseen || color_trust_of(v.color[i]) == 0) continue;
    if (std::fabs(static_cast<float>(v.tsdf[i])) > near) continue;
    const double r = red_of(v.color[i]), g = green_of(v.color[i]), b = blue_of(v.color[i]);
    const double grey = 0.299 * r + 0.587 * g + 0.114 * b;
    sum += grey;
    squares += grey * grey;
    red += r / (r + g + b + 1);
    green += g / (r + g + b + 1);
    ++stats.voxels;
  }
  if (stats.voxels == 0) return stats;
  const double n = stats.voxels, mean = sum / n, variance = squares / n - mean * mean;
  stats.luminance = static_cast<float>(mean);
  stats.luminance_sigma = static_cast<float>(std::sqrt(variance > 0 ? variance : 0));
  stats.red_share = static_cast<float>(red / n);
  stats.green_share = static_cast<float>(green / n);
  return stats;
}

Appearance appearance_of(const ModelTraits& traits) {
  return {static_cast<float>(traits.bounds.low.z), traits.color.luminance};
}

bool may_be(const ModelTraits& model, const ModelTraits& seen, bool cut) {
  constexpr float kMostHueApart = 0.15f;
  if (!size_fits(model.bounds, seen.bounds, cut)) return false;
  if (!model.color.known() || !seen.color.known()) return true;
  const float red = model.color.red_share - seen.color.red_share;
  const float green = model.color.green_share - seen.color.green_share;
  return red * red + green * green < kMostHueApart * kMostHueApart;
}

}  // namespace st
