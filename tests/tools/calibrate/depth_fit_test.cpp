#include "tools/calibrate/depth_fit.hpp"

#include <cmath>
#include <vector>

#include "tests/support/test_scene.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;

namespace {

constexpr int kWidth = 320, kHeight = 240;

// A bowl with a twist: nothing of it is linear over the image's seen part for long.
double bow_steps(int u, int v) {
  const double x = (u - 160) / 160.0, y = (v - 120) / 120.0;
  return 2.0 * (x * x + y * y) - 1.2 + 0.8 * x * y;
}

FloorView view_of(test::TestScene scene, bool bowed, double raw_b_error = 0) {
  Calibration calibration = test::kinect_calibration(kWidth, kHeight);
  test::SceneCamera camera(calibration);
  calibration.raw_b += raw_b_error;
  FloorView view(calibration);
  for (int i = 0; i < 12; ++i) {
    std::vector<std::uint16_t> raw = camera.render(scene).raw;
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) {
        std::uint16_t& reading = raw[static_cast<std::size_t>(v * kWidth + u)];
        // Rounded up or down by turns, so that the mean has the fraction.
        const double dither = (0.5 + i) / 12;
        if (bowed && reading != 2047)
          reading = static_cast<std::uint16_t>(std::floor(reading + bow_steps(u, v) + dither));
      }
    FrameInput frame;
    frame.depth = {raw.data(), kWidth, kHeight};
    view.add(frame);
  }
  return view;
}

test::TestScene bare_floor(double pitch_rad) {
  test::TestScene scene;
  scene.pitch_rad = pitch_rad;
  scene.wall_y = 20;
  scene.noise_raw = 0.4;
  return scene;
}

}  // namespace

TEST_GROUP(DepthFit){};

TEST(DepthFit, ABowIsFoundAndTakenOff) {
  const Calibration calibration = test::kinect_calibration(kWidth, kHeight);
  FloorView view = view_of(bare_floor(0.85), true);
  const Floor floor = view.find_floor();
  CHECK(floor.found);
  const DepthFit fit = fit_depth(calibration, {view.samples(floor)});
  CHECK(fit.worth_it());
  CHECK(fit.before_steps > 0.4);
  CHECK(fit.after_steps < 0.15);
  CHECK(fit.seen_share > 0.95);
  // What is linear over the image is the floor's; second differences are the sensor's alone.
  const auto bend = [&](auto f) { return f(40, 120) - 2 * f(160, 120) + f(280, 120); };
  const double truth = bend([](int u, int v) { return bow_steps(u, v); });
  const double found = bend([&](int u, int v) { return fit.correction.at(u, v, kWidth, kHeight); });
  DOUBLES_EQUAL(truth, found, 0.25);
}

TEST(DepthFit, ASensorWithoutBowGetsNoCorrection) {
  FloorView view = view_of(bare_floor(0.85), false);
  const Floor floor = view.find_floor();
  const DepthFit fit = fit_depth(test::kinect_calibration(kWidth, kHeight), {view.samples(floor)});
  CHECK(!fit.worth_it());
  DOUBLES_EQUAL(0, fit.before_steps, 0.1);
}

TEST(DepthFit, AWallAndABoxAreNoFloor) {
  test::TestScene scene = bare_floor(0.7);
  scene.wall_y = 2.2;
  scene.boxes = {{0.2, 1.4, 0, 0.4, 0.3, 0.25, 0.3}};
  FloorView view = view_of(scene, false);
  test::SceneCamera camera(test::kinect_calibration(kWidth, kHeight));
  const std::vector<std::uint8_t> mask = camera.render(scene).mask;
  const Floor floor = view.find_floor();
  CHECK(floor.found);
  const DepthFit fit = fit_depth(test::kinect_calibration(kWidth, kHeight), {view.samples(floor)});
  CHECK(!fit.worth_it());
  DOUBLES_EQUAL(1.2, plane_of(test::kinect_calibration(kWidth, kHeight), fit.floors[0]).height_m, 0.003);
  // A patch may hold a corner of the box: the fit's gate takes those pixels out.
  std::size_t on_box = 0;
  const FloorSamples samples = view.samples(floor);
  for (const FloorSample& sample : samples)
    on_box += mask[static_cast<std::size_t>(sample.v * kWidth + sample.u)] > 0 ? 1 : 0;
  CHECK(on_box * 200 < samples.size());
}

TEST(DepthFit, ATapeFindsTheSensorsConstant) {
  constexpr double kError_steps = 4;
  Calibration calibration = test::kinect_calibration(kWidth, kHeight);
  const double truth = calibration.raw_b;
  calibration.raw_b += kError_steps;
  FloorView steep = view_of(bare_floor(1.1), false, kError_steps),
            less = view_of(bare_floor(0.8), false, kError_steps);
  const DepthFit fit =
      fit_depth(calibration, {steep.samples(steep.find_floor()), less.samples(less.find_floor())});
  CHECK(std::fabs(plane_of(calibration, fit.floors[0]).height_m - 1.2) > 0.01);
  const HeightFit heights = fit_heights(calibration, fit.floors, {1.2, 1.2});
  DOUBLES_EQUAL(truth, heights.raw_b, 0.3);
  CHECK(heights.sigma_steps > 0.2 && heights.sigma_steps < 1.0);
}

TEST(DepthFit, NoFloorIsSaid) {
  test::TestScene scene = bare_floor(0.2);
  scene.floor = false;
  scene.wall_y = 2;
  CHECK(!view_of(scene, false).find_floor().found);
}
