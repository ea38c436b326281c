// A whole colour frame brought into the depth camera's pixels.
#pragma once

#include "algo/core/calibration.hpp"
#include "algo/core/pinhole.hpp"
#include "algo/tracking/observe.hpp"

namespace st {

// Writes pack_rgb colours (alpha 255; 0 without depth, or where the colour image does not reach) for every
// pixel: that of the nearest colour pixel, through the colour lens with its distortion. `motion` takes a
// point from the depth frame's instant to the colour frame's (camera frame). Rows of depth_z must be followed
// by 16 readable elements. False, and nothing written, for an image of another size than the calibration's.
bool frame_colors(const Calibration& calibration, const ColorImage& image, const PoseF& motion,
                  ImageView<const float> depth_z, const Pinhole& camera, ImageView<std::uint32_t> color);

}  // namespace st
