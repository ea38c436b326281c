// The images of the present frame that several stages share. Memory is the plan's; contents are replaced
// every frame.
#pragma once

#include "algo/core/bump.hpp"
#include "algo/core/image.hpp"
#include "algo/core/records.hpp"
#include "algo/tracking/model_view.hpp"
#include "algo/tracking/observe.hpp"

namespace st {

struct Frame {
  const FrameInput* input = nullptr;
  Pinhole camera;
  ImageView<float> depth_z;  // metres, 0 = none; ideal pinhole grid
  ImageView<std::uint8_t>
      owners;  // 0 none, k + 1: tracks[k]; of this frame after associate(), of the last one before
  ColorImage color;
  bool has_color = false;
  double color_lag_s = 0;  // colour exposure minus depth exposure

  void bind(Bump& memory, int width, int height) {
    const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    depth_z = {memory.take<float>(n).data(), width, height};
    owners = {memory.take<std::uint8_t>(n).data(), width, height};
  }
};

}  // namespace st
