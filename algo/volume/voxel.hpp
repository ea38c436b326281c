// How one voxel is written down: 8 bytes in four arrays. Plain constants and integer packing only, so that
// the vector kernels and the tests' oracles share them.
#pragma once

#include <cstdint>

namespace st {

// Signed distance (Curless & Levoy 1996): +-32767 is +-truncation, positive on the camera's side of the
// surface. Full 16 bits, because a coarser step with a running average drifts by its rounding.
inline constexpr std::int16_t kUnseen = -32768;
inline constexpr float kTsdfScale = 32767.0f;

// Weight in halves of a nominal observation: 127 is the largest cap that a byte holds.
inline constexpr float kWeightUnits = 2.0f;
inline constexpr float kMaxWeightCap = 127.0f;

// Colour word: r, g, b means, then a byte of state: trust (0: no colour known ... 15) in the high half and
// the standard deviation in the low half, in steps of three grey levels from three.
inline constexpr float kSpreadStep = 3.0f;
inline constexpr float kFirstSpread = 24.0f;  // before there is anything to compare with

constexpr std::uint32_t pack_rgb(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a = 255) {
  return static_cast<std::uint32_t>(r) | (static_cast<std::uint32_t>(g) << 8) |
         (static_cast<std::uint32_t>(b) << 16) | (static_cast<std::uint32_t>(a) << 24);
}
constexpr std::uint8_t red_of(std::uint32_t c) { return static_cast<std::uint8_t>(c); }
constexpr std::uint8_t green_of(std::uint32_t c) { return static_cast<std::uint8_t>(c >> 8); }
constexpr std::uint8_t blue_of(std::uint32_t c) { return static_cast<std::uint8_t>(c >> 16); }
constexpr std::uint8_t alpha_of(std::uint32_t c) { return static_cast<std::uint8_t>(c >> 24); }
constexpr int color_trust_of(std::uint32_t c) { return static_cast<int>(c >> 28); }
constexpr float color_sigma_of(std::uint32_t c) {
  return kSpreadStep * static_cast<float>(((c >> 24) & 15u) + 1u);
}

inline constexpr int kBrickSide = 8;

// A brick of 8 x 8 x 8 voxels.
enum BrickFlag : std::uint8_t {
  kBrickTouched = 1,  // some voxel was ever written: what reset() must clear
  kBrickSolid = 2,    // some voxel lies behind the surface: where rays, meshing and carving have to look
};

}  // namespace st
