#include "algo/tracking/color_frame.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

#include "tests/algo/tracking/seen_colors.hpp"

using namespace st;
using namespace st::test;

namespace {

constexpr Pinhole kCamera{150, 150, 79.5f, 59.5f, 160, 120};

double wave(double u, double v) { return 120 + 40 * std::sin(0.15 * u) + 30 * std::cos(0.11 * v); }

}  // namespace

TEST_GROUP(ColorFrame){};

TEST(ColorFrame, HoldsTheImageAndItsSlopes) {
  const SeenColors colors(kCamera, wave);
  const ColorFrame& frame = colors.frame;
  for (int v = 5; v < 115; v += 7)
    for (int u = 5; u < 155; u += 7) {
      DOUBLES_EQUAL(wave(u, v), colors.at(u, v), 1.0);  // smoothed, and rounded to a byte
      const ColorPixel& pixel =
          frame.pixels[static_cast<std::size_t>((v - frame.roi.v0) * frame.roi.width() + u - frame.roi.u0) +
                       1];
      DOUBLES_EQUAL(40 * 0.15 * std::cos(0.15 * u), pixel.du / double{kLuminanceScale}, 0.5);
      DOUBLES_EQUAL(-30 * 0.11 * std::sin(0.11 * v), pixel.dv / double{kLuminanceScale}, 0.5);
    }
  LONGS_EQUAL(kNoColor, frame.pixels[0].luminance);
  LONGS_EQUAL(kNoColor, frame.pixels[1].luminance);  // a corner has no slope
}

TEST(ColorFrame, TakesOverNoMoreThanWhereTheBoxMayAppear) {
  SeenColors colors(kCamera, wave);
  build_color_frame(colors.registration, colors.image(), kCamera, {40, 30, 60, 50}, colors.frame);
  const Rect& roi = colors.frame.roi;
  CHECK(roi.u0 <= 40 && roi.v0 <= 30 && roi.u1 >= 60 && roi.v1 >= 50);
  CHECK(roi.u0 >= 25 && roi.v0 >= 15 && roi.u1 <= 75 && roi.v1 <= 65);
  DOUBLES_EQUAL(wave(50, 40), colors.at(50, 40), 1.0);
  build_color_frame(colors.registration, colors.image(), kCamera, {0, 0, 0, 0}, colors.frame);
  CHECK(colors.frame.empty());
}

TEST(ColorFrame, SeesNearAndFarThingsThroughAColourCameraBeside) {
  Calibration calibration;
  calibration.depth = intrinsics_of(kCamera);
  calibration.color = intrinsics_of(kCamera);
  calibration.has_color = true;
  calibration.T_color_depth.t = {-0.1, 0, 0};
  SeenColors colors(calibration, kCamera, wave);
  build_color_frame(colors.registration, colors.image(), kCamera, {100, 40, 120, 60}, colors.frame);
  for (const double z : {0.5, 1.0, 8.0}) {
    const double u = 110 - 150 * 0.1 / z;
    CHECK(colors.frame.roi.u0 <= u && u < colors.frame.roi.u1);
  }
}

TEST(ColorFrame, TakesTheLensOut) {
  Calibration calibration = SeenColors::registered(kCamera);
  calibration.depth.k[0] = -0.2;
  calibration.depth.k[1] = 0.05;
  // The distorted image of a pattern that is given in ideal pixels: each distorted pixel shows what lies
  // there.
  const auto undistorted = [&](double u, double v) {
    Normalized p{(u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy}, x = p;
    for (int i = 0; i < 30; ++i) {
      const Normalized d = distort(calibration.depth, x);
      x = {x.x + p.x - d.x, x.y + p.y - d.y};
    }
    return wave(x.x * kCamera.fx + kCamera.cx, x.y * kCamera.fy + kCamera.cy);
  };
  const SeenColors colors(calibration, kCamera, [&](int u, int v) { return undistorted(u, v); });
  for (int v = 20; v < 100; v += 9)
    for (int u = 20; u < 140; u += 9) DOUBLES_EQUAL(wave(u, v), colors.at(u, v), 1.5);
}
