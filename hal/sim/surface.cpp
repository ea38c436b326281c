#include "hal/sim/surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace st::sim {
namespace {

std::uint32_t to_byte(float x) {
  return static_cast<std::uint32_t>(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f);
}

std::uint32_t packed(const Paint& p) {
  return to_byte(p.r) | to_byte(p.g) << 8 | to_byte(p.b) << 16 | to_byte(p.ir) << 24;
}

std::uint32_t average(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  std::uint32_t out = 0;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    const std::uint32_t sum =
        ((a >> shift) & 255) + ((b >> shift) & 255) + ((c >> shift) & 255) + ((d >> shift) & 255);
    out |= ((sum + 2) / 4) << shift;
  }
  return out;
}

}  // namespace

Texture::Texture(int side_log2, float period_m, const std::function<Paint(float, float)>& paint_at)
    : side_log2_(side_log2), texels_per_m_(static_cast<float>(1 << side_log2) / period_m) {
  const std::size_t side = std::size_t{1} << side_log2;
  std::vector<std::uint32_t> level(side * side);
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i)
      level[j * side + i] = packed(paint_at((static_cast<float>(i) + 0.5f) / texels_per_m_,
                                            (static_cast<float>(j) + 0.5f) / texels_per_m_));
  levels_.push_back(std::move(level));
  for (std::size_t s = side / 2; s >= 1; s /= 2) {
    const std::vector<std::uint32_t>& fine = levels_.back();
    std::vector<std::uint32_t> coarse(s * s);
    for (std::size_t j = 0; j < s; ++j)
      for (std::size_t i = 0; i < s; ++i) {
        const std::size_t k = 4 * j * s + 2 * i;
        coarse[j * s + i] = average(fine[k], fine[k + 1], fine[k + 2 * s], fine[k + 2 * s + 1]);
      }
    levels_.push_back(std::move(coarse));
  }
}

std::uint32_t Texture::at(float u_m, float v_m, float footprint_m) const {
  // The exponent of a float is its whole logarithm: enough to choose a level.
  const float texels = std::max(footprint_m * texels_per_m_, 1.0f);
  const int level =
      std::min(static_cast<int>(std::bit_cast<std::uint32_t>(texels * 1.4f) >> 23) - 127, side_log2_);
  const int side = 1 << (side_log2_ - level);
  const float scale = texels_per_m_ / static_cast<float>(1 << level);
  const int i = static_cast<int>(std::floor(u_m * scale)) & (side - 1);
  const int j = static_cast<int>(std::floor(v_m * scale)) & (side - 1);
  return levels_[static_cast<std::size_t>(level)][static_cast<std::size_t>(j * side + i)];
}

}  // namespace st::sim
