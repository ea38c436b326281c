#include "algo/tracking/frame_colors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "algo/volume/voxel.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;

namespace {

constexpr int kW = 37, kH = 20;  // no multiple of any vector's width

struct Frames {
  Frames() : z(kW * kH + 16, 1.0f), rgb(3 * kW * kH), out(kW * kH, 7) {
    for (int i = 0; i < kW * kH; ++i) {
      rgb[static_cast<std::size_t>(3 * i)] = static_cast<std::uint8_t>(i % kW);
      rgb[static_cast<std::size_t>(3 * i + 1)] = static_cast<std::uint8_t>(i / kW);
      rgb[static_cast<std::size_t>(3 * i + 2)] = 99;
    }
    calibration.has_color = true;
    calibration.depth = calibration.color = {kW, kH, 30, 30, 18, 9.5, {0, 0, 0, 0, 0}};
  }
  bool take(const PoseF& motion = {}) {
    return frame_colors(calibration, {{rgb.data(), 3 * kW, kH}}, motion, {z.data(), kW, kH},
                        Pinhole::of(calibration.depth), {out.data(), kW, kH});
  }
  std::uint32_t at(int u, int v) const { return out[static_cast<std::size_t>(v * kW + u)]; }

  Calibration calibration;
  std::vector<float> z;
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint32_t> out;
};

}  // namespace

TEST_GROUP(FrameColors) { Frames f; };

TEST(FrameColors, RegisteredColourStaysInItsPixel) {
  f.calibration.color_registered = true;
  f.z[5] = 0;
  CHECK(f.take());
  UNSIGNED_LONGS_EQUAL(0, f.at(5, 0));
  for (int v = 0; v < kH; ++v)
    for (int u = 0; u + 1 < kW; ++u) {
      if (u == 5 && v == 0) continue;
      UNSIGNED_LONGS_EQUAL(pack_rgb(static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v), 99),
                           f.at(u, v));
    }
}

TEST(FrameColors, ACameraBesideShiftsByItsParallaxAndMotionAddsToIt) {
  f.calibration.T_color_depth.t = {0.1, 0, 0};  // three pixels at one metre
  CHECK(f.take());
  UNSIGNED_LONGS_EQUAL(13, red_of(f.at(10, 4)));
  UNSIGNED_LONGS_EQUAL(0, f.at(kW - 2, 4));  // beyond the colour image
  CHECK(f.take({Mat3f{}, {0, 0.1f, 0}}));
  UNSIGNED_LONGS_EQUAL(13, red_of(f.at(10, 4)));
  UNSIGNED_LONGS_EQUAL(7, green_of(f.at(10, 4)));
}

TEST(FrameColors, AnImageOfAnotherSizeIsRefused) {
  f.calibration.color.width = kW + 1;
  CHECK(!f.take());
  UNSIGNED_LONGS_EQUAL(7, f.at(0, 0));
}

TEST(FrameColors, ALensWithDistortionIsLookedThroughWhereItBendsTheRay) {
  const double bent[] = {0.2, -0.3, 0.02, -0.015, 0.1};
  const auto check = [&](Intrinsics& lens) {
    std::copy(std::begin(bent), std::end(bent), lens.k);
    CHECK(f.take());
    int moved = 0;
    for (int v = 0; v < kH; ++v)
      for (int u = 0; u < kW; ++u) {
        const Normalized at = distort(lens, {(u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy});
        const double cu = at.x * lens.fx + lens.cx + 0.5, cv = at.y * lens.fy + lens.cy + 0.5;
        // Not where rounding decides: on a pixel's edge, and at that of the image.
        const auto near_edge = [](double c) { return std::fabs(c - std::round(c)) < 1e-3; };
        if (near_edge(cu) || near_edge(cv) || cu < 0 || cv < 0 || cu >= kW - 1 || cv >= kH) continue;
        LONGS_EQUAL(static_cast<int>(cu), red_of(f.at(u, v)));
        LONGS_EQUAL(static_cast<int>(cv), green_of(f.at(u, v)));
        moved += static_cast<int>(cu) != u ? 1 : 0;
      }
    CHECK(moved > kW);
  };
  check(f.calibration.color);
  f.calibration.color_registered = true;
  check(f.calibration.depth);
}
