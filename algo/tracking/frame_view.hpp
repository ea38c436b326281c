// The frame before as a "model": the paper's first approach (section 4.2) aligns each frame with the
// preceding one. Fast to converge, and every small error stays for ever; keyframes are its intermediate
// calibration stages.
#pragma once

#include "algo/core/bump.hpp"
#include "algo/tracking/model_view.hpp"

namespace st {

struct FrameViewMemory {
  ModelView view;
  int surface_pixels = 0;
  int age = 0;  // frames since it was taken

  void bind(Bump& memory, int max_width, int max_height) { view.maps.bind(memory, max_width, max_height); }
};

// Takes the owner's pixels of `roi` with normals from a plane fitted to each 7x7 window (depth steps are
// wider than a pixel's slope), and colours. T_camera_object: the pose that this frame was given.
void remember_frame(FrameViewMemory& memory, ImageView<const float> depth_z,
                    ImageView<const std::uint8_t> owners, std::uint8_t owner, Rect roi, const Pinhole& camera,
                    ImageView<const std::uint32_t> color, const Pose& T_camera_object);

}  // namespace st
