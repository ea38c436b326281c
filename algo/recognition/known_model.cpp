#include "algo/recognition/known_model.hpp"

#include <cmath>

#include "algo/recognition/volume_fit.hpp"
#include "algo/tracking/recover.hpp"

namespace st {
namespace {

struct ColorSums {
  double grey = 0, squares = 0, red = 0, green = 0;
  std::uint32_t n = 0;

  void add(std::uint32_t c) {
    const double r = red_of(c), g = green_of(c), b = blue_of(c);
    const double level = 0.299 * r + 0.587 * g + 0.114 * b;
    grey += level;
    squares += level * level;
    red += r / (r + g + b + 1);
    green += g / (r + g + b + 1);
    ++n;
  }
  ColorStats stats() const {
    if (n == 0) return {};
    const double mean = grey / n, variance = squares / n - mean * mean;
    return {static_cast<float>(mean), static_cast<float>(std::sqrt(variance > 0 ? variance : 0)),
            static_cast<float>(red / n), static_cast<float>(green / n), n};
  }
};

}  // namespace

ColorStats color_stats(const Volume& v) {
  ColorSums sums;
  const float near = 0.5f * v.voxel_m / v.truncation_m * kTsdfScale;
  const int b = v.bricks_a_side();
  for (int bz = 0; bz < b; ++bz)
    for (int by = 0; by < b; ++by)
      for (int bx = 0; bx < b; ++bx) {
        if ((v.bricks[v.brick_index(bx, by, bz)] & kBrickSolid) == 0) continue;
        for (int row = 0; row < kBrickSide * kBrickSide; ++row) {
          const std::size_t at = v.index(bx * kBrickSide, by * kBrickSide + row % kBrickSide,
                                         bz * kBrickSide + row / kBrickSide);
          for (std::size_t i = at; i < at + kBrickSide; ++i)
            if (color_trust_of(v.color[i]) != 0 && std::fabs(static_cast<float>(v.tsdf[i])) <= near)
              sums.add(v.color[i]);
        }
      }
  return sums.stats();
}

Appearance appearance_of(const ModelTraits& traits) {
  const auto low = static_cast<float>(traits.bounds.low.z), high = static_cast<float>(traits.bounds.high.z);
  return {low, low + skirt_m(high - low), traits.color.luminance};
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
