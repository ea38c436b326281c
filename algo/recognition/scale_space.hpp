// Gaussian scale space of a volume (paper, section 3.3: L = G * I with G of width k sigma), in octaves of
// half the resolution each; the difference of two neighbouring levels is the DoG.
#pragma once

#include "algo/core/bump.hpp"
#include "algo/recognition/grid.hpp"

namespace st {

inline constexpr int kScalesPerOctave = 3;               // in which extrema are looked for
inline constexpr int kGaussians = kScalesPerOctave + 3;  // levels of an octave
inline constexpr int kDogs = kGaussians - 1;
inline constexpr int kMaxOctaves = 4;
inline constexpr float kFirstSigma = 1.6f;     // of level 0, in voxels of its octave
inline constexpr float kNominalSigma = 1.15f;  // that the input has already
inline constexpr int kSmallestOctave = 16;     // voxels a side: below, a descriptor covers everything

// Taps of a sampled Gaussian that sum to 1: taps[0] is the middle, taps[k] stands k voxels off on both sides.
// Returns the radius: three sigma, at most kMostTaps.
int gaussian_taps(float sigma, float* taps);

struct ScaleSpace {
  int octaves = 0;
  Grid levels[kMaxOctaves][kGaussians];
  std::span<float> rows;  // work memory: one row with both its ends drawn out
  std::span<float> pass;  // work memory: a volume between two passes

  // side: of the input, a power of two from 32 to 256.
  void bind(Bump& memory, int side);

  // One third of one level: blurs along x (axis 0), y (1), then z (2). All passes before it must be done.
  // Level 0 of octave 0 comes from `input`; of later octaves from the octave before, at twice its first
  // sigma, every second voxel.
  void blur_pass(const Grid& input, int octave, int level, int axis);

  // DoG `level` of an octave at a voxel: the difference of Gaussian level + 1 and level.
  float dog(int octave, int level, std::size_t at) const {
    return levels[octave][level + 1].values[at] - levels[octave][level].values[at];
  }
  // Blur of a level in voxels of its octave.
  static float sigma_of(float level);
};

}  // namespace st
