// What a keypoint's neighbourhood looks like in its own frame: 4 x 4 x 4 cells of 8 x 4 directions, 2,048
// numbers (paper, section 3.3).
#pragma once

#include <cstdint>

#include "algo/core/bump.hpp"
#include "algo/recognition/grid.hpp"

namespace st {

inline constexpr int kCellsPerAxis = 4, kAzimuthBins = 8, kElevationBins = 4;
inline constexpr int kDescriptorLength =
    kCellsPerAxis * kCellsPerAxis * kCellsPerAxis * kAzimuthBins * kElevationBins;
static_assert(kDescriptorLength == 2048);

// Element ((z * 4 + y) * 4 + x) * 32 + elevation * 8 + azimuth: cell (x, y, z) along the frame's axes,
// azimuth of the gradient from the frame's x axis counter-clockwise about z, elevation from -z up. Unit
// length, then cut at kLargestElement, then unit length again.
// A hundredth of what Lowe's 128 numbers are cut at would cut nearly all of 2,048: the same multiple of an
// even spread, 0.2 sqrt(128 / 2048).
inline constexpr float kLargestElement = 0.05f;

struct Descriptor {
  std::uint8_t bytes[kDescriptorLength];  // times kByteScale, 255 at most
};
inline constexpr float kByteScale = 2048;

// Half the side of the cube that is described, in sigmas of the keypoint: a cell is 3 sigma wide (Lowe 2004).
inline constexpr float kHalfWidthSigmas = 6;
// Samples of the gradient along each axis: a fixed number, so that the cost does not grow with the scale.
inline constexpr int kSamplesPerAxis = 16;

// The histogram as it is summed up: kDescriptorLength floats, normalised as above. level: the Gaussian level
// of the keypoint; voxel and sigma in its voxels; p_level = R p_keypoint.
void describe(const Grid& level, const Vec3f& voxel, float sigma, const Mat3f& R, std::span<float> histogram);

Descriptor to_bytes(std::span<const float> histogram);

}  // namespace st
