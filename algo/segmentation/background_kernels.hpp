// The dense loops of the background, one row at a time on plain arrays. Values are in eighths of a code.
#pragma once

#include <cstdint>

namespace st::background_kernels {

inline constexpr std::uint16_t kUnit = 8;
inline constexpr std::uint16_t kMostTolerance = 60000;
// 18 codes: two and a quarter Kinect steps. A robot of 8 cm before a floor seen from 1.25 m above stands out
// by q h / H = 70 codes at 2.5 m.
inline constexpr std::uint16_t kLeastTolerance = 18 * kUnit;

// High half of a 16x16 product: one instruction, eight at a time.
constexpr std::uint16_t high(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint16_t>((static_cast<std::uint32_t>(a) * b) >> 16);
}

// Below this, a reading never differs from its background: noise, and two steps of the stored values, which
// are q^2 step_per_squared_code codes wide; high(8q, 8q) is q^2 / 1024.
constexpr std::uint16_t least_tolerance(std::uint16_t code8, std::uint16_t step_factor) {
  return static_cast<std::uint16_t>(kLeastTolerance + high(high(code8, code8), step_factor));
}

// PixelClass of each pixel.
void classify(const std::uint16_t* code, const std::uint16_t* mean, const std::uint16_t* tolerance,
              std::uint8_t* out, int width);

// Moves the mean of agreeing pixels that nobody owns towards the reading by one unit, which makes it a median
// and bounds what a slowly creeping surface can pull; the tolerance follows a quantile of the deviations
// (stochastic approximation, Robbins & Monro 1951): in balance 4 % of them lie beyond a third of it.
void drift(const std::uint16_t* code, const std::uint8_t* kind, const std::uint8_t* owner,
           std::uint16_t* mean, std::uint16_t* tolerance, int width, std::uint16_t step_factor);

// One frame of learning. A pixel's first surface: its mean (`weight` = 65536 / frame number is the new
// reading's), the largest deviation in `spread`, the frames that agreed in the low half of `count`.
// `changes`: bit 7 says that the frame before did not agree, below it how often that turned. `out`: kHole
// without a reading, kFarther where the reading is of another surface (left to the caller), else kSame.
void learn(const std::uint16_t* code, std::uint16_t* mean, std::uint16_t* spread, std::uint8_t* count,
           std::uint8_t* changes, std::uint8_t* out, int width, std::uint16_t weight,
           std::uint16_t step_factor);

}  // namespace st::background_kernels
