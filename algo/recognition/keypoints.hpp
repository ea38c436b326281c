// Extrema of the DoG in x, y, z and scale, and which of them are kept (paper, section 3.3).
#pragma once

#include <cstdint>

#include "algo/core/fixed_vector.hpp"
#include "algo/recognition/scale_space.hpp"

namespace st {

inline constexpr int kMaxKeypoints = 200;

struct Keypoint {
  int octave = 0, level = 0;  // DoG level, 1 ... kScalesPerOctave
  Vec3f voxel{};              // place in its octave, between voxels
  float sigma = 0;            // in voxels of its octave
  float contrast = 0;         // |DoG|
};
using Keypoints = FixedVector<Keypoint, kMaxKeypoints>;

// Of which neighbours an extremum is one: all 80 in x, y, z and scale (Lowe 2004, in three dimensions), or
// the six beside it and the two of its own place in the scales above and below (Rister et al. 2017), which
// finds more on things with few details.
enum class Neighbours : std::uint8_t { kAll80, kNearest8 };

struct KeypointLimits {
  Neighbours neighbours = Neighbours::kAll80;
  float least_contrast_share = 0.1f;  // of the largest |DoG| of the level
  float least_contrast = 0.004f;      // and of the input's unit
  // Largest ratio of the DoG's principal curvatures. Along an edge one of the three is small, on a plane two
  // are: the extremum may slide there. Test: tr^3 / det < (2 r + 1)^3 / r^2 (Lowe 2004, section 4.1, for
  // three curvatures r, r, 1).
  float largest_curvature_ratio = 10;
  int most_described = kMaxKeypoints;  // the strongest; the others get no descriptor
};

struct KeypointCounts {
  int extrema = 0;       // strict extrema among their neighbours
  int low_contrast = 0;  // of these: refused for contrast
  int flat = 0;          // for a small curvature
  int crowded_out = 0;   // for stronger ones when there were more than kMaxKeypoints
};

// Looks through one DoG level (1 ... kScalesPerOctave) of one octave. The strongest are kept.
void find_keypoints(const ScaleSpace& space, int octave, int level, const KeypointLimits& limits,
                    Keypoints& found, KeypointCounts& counts);

}  // namespace st
