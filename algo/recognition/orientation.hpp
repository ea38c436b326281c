// The frame of a keypoint: azimuth and elevation of the dominant gradient, and the tilt about it (Allaire et
// al. 2008, the paper's reference [27]). Where several are about as strong there are several frames.
#pragma once

#include "algo/recognition/grid.hpp"

namespace st {

inline constexpr int kMaxOrientations = 4;

// level: the Gaussian level of the keypoint; voxel, sigma: in its voxels. Column 0 of a frame is the dominant
// direction, column 1 the strongest one across it; p_level = R p_keypoint. Returns how many there are; none
// where the neighbourhood is flat, or no direction across the dominant one stands out.
int find_orientations(const Grid& level, const Vec3f& voxel, float sigma, Mat3f (&frames)[kMaxOrientations]);

}  // namespace st
