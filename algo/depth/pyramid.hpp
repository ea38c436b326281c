// A depth image in metres and its halves, for work from coarse to fine.
#pragma once

#include "algo/core/bump.hpp"
#include "algo/core/image.hpp"
#include "algo/core/pinhole.hpp"
#include "algo/depth/depth_tables.hpp"

namespace st {

struct DepthPyramid {
  static constexpr int kLevels = 3;
  struct Level {
    ImageView<float> z;  // metres, 0: none
    Pinhole camera;
  };
  Level levels[kLevels];  // levels[0]: as measured

  // `camera`: of the measured image; any size.
  void bind(Bump& memory, const Pinhole& camera);
};

// Stored values to metres on the ideal pinhole grid, 0 where there is no reading or one outside of 0.35-10 m,
// and the halves of that: a coarse pixel is the mean of those of its four that lie on one surface with the
// nearest. A frame of another size than the calibration's has no reading. Returns the pixels without one.
std::uint32_t fill_pyramid(const DepthTables& tables, ImageView<const std::uint16_t> stored,
                           DepthPyramid& pyramid);

}  // namespace st
