// The gate that every depth pixel passes: stored values to inverse-depth codes on the ideal pinhole grid.
// What has no reading, or one outside of 0.35-10 m, becomes 0 here and nothing behind ever sees it.
#pragma once

#include <cstdint>

#include "algo/core/image.hpp"
#include "algo/depth/depth_tables.hpp"

namespace st {

struct CleanDepth {
  ImageView<const std::uint16_t> code;    // 0: no reading
  ImageView<const std::uint16_t> stored;  // the same pixels as stored (metres: DepthTables::z_of_stored)
  std::uint32_t invalid_pixels = 0;
};

// Writes `code`, and `stored` when the camera has lens distortion (it is not touched, and may be empty,
// otherwise: the input itself is then handed on). A frame of another size than the calibration's is all
// invalid.
CleanDepth preprocess(const DepthTables& tables, ImageView<const std::uint16_t> depth,
                      ImageView<std::uint16_t> code, ImageView<std::uint16_t> stored);

// Depth in metres of every code, 0 where there is none: z_of_code() to the last bit but one. The division,
// four pixels at a time, is faster than the table, whose memory is needed for other things.
void to_metres(const DepthTables& tables, ImageView<const std::uint16_t> code, ImageView<float> z_m);

}  // namespace st
