// The model of one object (or of the scene): a truncated signed distance function with colour in a fixed cube
// of voxels, on memory that the caller owns. Frame: the object's, metres. Voxel (x, y, z) has its centre at
// origin + voxel_m * (x, y, z).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/linear.hpp"
#include "algo/volume/voxel.hpp"

namespace st {

struct Volume {
  int side = 0;  // voxels a side, a multiple of 8
  float voxel_m = 0.004f;
  float truncation_m = 0.016f;
  Vec3f origin{};                  // centre of voxel (0, 0, 0)
  std::uint32_t integrations = 0;  // frames written since reset()

  // x fastest, then y, then z. Long enough that a 32-bit load at the last voxel stays inside.
  std::span<std::int16_t> tsdf;
  std::span<std::uint8_t> weight;        // halves of a nominal observation; saturates at the cap
  std::span<std::uint8_t> observations;  // frames that saw the voxel near a surface; saturates at 255
  std::span<std::uint32_t> color;
  std::span<std::uint8_t> bricks;  // BrickFlag bits, same order
  std::span<std::uint8_t>
      octants;  // per brick: which of its 4 x 4 x 4 parts (bit: x + 2 y + 4 z) are solid somewhere

  // side: 64 to 512 in multiples of 8. The memory need not be zero; reset() has to follow, and that first one
  // clears all.
  void bind(Bump& memory, int voxels_a_side);

  // Empties the volume: only what was touched since the last time is cleared. `box_centre`: where the cube's
  // middle lies.
  void reset(float voxel, float truncation, const Vec3f& box_centre);

  int bricks_a_side() const { return side / kBrickSide; }
  std::size_t voxels() const {
    return static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  }
  std::size_t index(int x, int y, int z) const {
    const std::size_t n = static_cast<std::size_t>(side);
    return (static_cast<std::size_t>(z) * n + static_cast<std::size_t>(y)) * n + static_cast<std::size_t>(x);
  }
  std::size_t brick_index(int bx, int by, int bz) const {
    const std::size_t n = static_cast<std::size_t>(bricks_a_side());
    return (static_cast<std::size_t>(bz) * n + static_cast<std::size_t>(by)) * n +
           static_cast<std::size_t>(bx);
  }
  Vec3f position(int x, int y, int z) const {
    return origin + Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} * voxel_m;
  }
  float extent_m() const { return voxel_m * static_cast<float>(side - 1); }
  Vec3f centre() const {
    const float h = 0.5f * extent_m();
    return origin + Vec3f{h, h, h};
  }
};

// Moves the content so that what was at brick (bx, by, bz) is at brick (bx + shift): the cube moves the other
// way, the content keeps its place in the object frame. What leaves the cube is forgotten. Costs one pass
// over touched bricks.
struct BrickShift {
  int x = 0, y = 0, z = 0;
};
void recentre(Volume& volume, const BrickShift& shift);

// The shift that brings the cube's middle closest to `wanted` (object frame).
BrickShift shift_towards(const Volume& volume, const Vec3f& wanted);

// Voxel size for an object that was seen `extent_m` large (largest side) from one direction: leaves room for
// what is still hidden, and never below 2 mm, where a Kinect has nothing more to say.
float choose_voxel_m(float extent_m, int voxels_a_side);

// Truncation that noise does not reach often: three sigma, at least four voxels, at most ten.
float choose_truncation_m(float voxel_m, float depth_sigma_m);

struct SdfSample {
  float sdf_m = 0;
  Vec3f gradient{};  // of sdf_m over metres, object frame; about unit length, away from the solid
  bool valid = false;
};

// Trilinear distance and its exact gradient at p (object frame, metres); invalid where one of the eight
// voxels is unseen.
inline SdfSample sample(const Volume& v, const Vec3f& p) {
  const float inv = 1.0f / v.voxel_m;
  const Vec3f q = (p - v.origin) * inv;
  const float last = static_cast<float>(v.side - 1);
  // NaN fails every comparison, so this form refuses it.
  if (!(q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < last && q.y < last && q.z < last)) return {};
  const int x = static_cast<int>(q.x), y = static_cast<int>(q.y), z = static_cast<int>(q.z);
  const std::size_t n = static_cast<std::size_t>(v.side), at = v.index(x, y, z);
  const std::size_t offsets[4] = {0, n, n * n, n * n + n};
  float c[8];
  for (int i = 0; i < 4; ++i) {
    const std::int16_t lo = v.tsdf[at + offsets[i]], hi = v.tsdf[at + offsets[i] + 1];
    if (lo == kUnseen || hi == kUnseen) return {};
    c[2 * i] = lo;
    c[2 * i + 1] = hi;
  }
  const float a = q.x - static_cast<float>(x), b = q.y - static_cast<float>(y),
              d = q.z - static_cast<float>(z);
  const float x00 = c[0] + a * (c[1] - c[0]), x10 = c[2] + a * (c[3] - c[2]);
  const float x01 = c[4] + a * (c[5] - c[4]), x11 = c[6] + a * (c[7] - c[6]);
  const float y0 = x00 + b * (x10 - x00), y1 = x01 + b * (x11 - x01);
  const float g0 = (c[1] - c[0]) + b * ((c[3] - c[2]) - (c[1] - c[0]));
  const float g1 = (c[5] - c[4]) + b * ((c[7] - c[6]) - (c[5] - c[4]));
  const float scale = v.truncation_m / kTsdfScale;
  const Vec3f g{g0 + d * (g1 - g0), (x10 - x00) + d * ((x11 - x01) - (x10 - x00)), y1 - y0};
  return {scale * (y0 + d * (y1 - y0)), g * (scale * inv), true};
}

struct ColorSample {
  float r = 0, g = 0, b = 0;  // 0-255
  bool valid = false;
};

// Trilinear over those of the eight voxels whose colour is known; invalid when they carry less than half of
// the weight.
ColorSample sample_color(const Volume& volume, const Vec3f& p);

}  // namespace st
