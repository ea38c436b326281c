// A connected piece of foreground, measured.
#pragma once

#include <cstdint>

#include "algo/core/image.hpp"
#include "algo/core/linear.hpp"

namespace st {

struct Segment {
  Rect box{};
  int pixels = 0;
  float area_cm2 = 0;  // seen head-on
  Vec3f centroid_m{};  // camera frame, of the visible surface
  float extent_m = 0;  // along its longest direction, as for a disc of the same spread
  float mean_code = 0;
  bool has_height = false;        // a floor is known
  float bottom_m = 0, top_m = 0;  // above the floor, 2 % and 98 % quantiles
  bool touches_border = false;    // the edge of the view may cut it
  float unknown_share = 0;        // of pixels where no background is known
  bool from_background = false;   // mainly the thing that is in `released`
};

// What is summed up over a segment: its pixels are counted, and one in some of its cells is measured.
struct SegmentSums {
  static constexpr int kHeightBins = 200, kBinsBelowFloor = 50;  // of 1 cm

  Rect box = Rect::nothing();
  int pixels = 0, unknown = 0;     // pixels
  int cells = 0, rim_cells = 0;    // cells
  int measured = 0, released = 0;  // cells
  double code = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  std::uint32_t heights[kHeightBins]{};

  void add(std::uint16_t q, const Vec3& p) {
    x += p.x, y += p.y, z += p.z;
    xx += p.x * p.x, xy += p.x * p.y, xz += p.x * p.z, yy += p.y * p.y, yz += p.y * p.z, zz += p.z * p.z;
    code += q;
    ++measured;
  }
  void add_height(float height_m) {  // whole centimetres, truncated
    const int bin = static_cast<int>(height_m * 100.0f + static_cast<float>(kBinsBelowFloor));
    ++heights[bin < 0 ? 0 : bin >= kHeightBins ? kHeightBins - 1 : bin];
  }
};

// Box, size and place of what was summed (measured > 0). `view`: the part of the image that has readings.
Segment describe(const SegmentSums& sums, float area_cm2, bool has_height, const Rect& view);

// Whether the view's edge may cut what lies in `box`: part of it is perhaps outside.
bool is_cut(const Rect& box, const Rect& view);

}  // namespace st
