#include "algo/segmentation/proto_texture.hpp"

#include <CppUTest/TestHarness.h>

#include <vector>

#include "algo/segmentation/segmenter.hpp"
#include "tests/support/bound.hpp"
#include "tests/support/test_scene.hpp"

using namespace st;

namespace {

constexpr int kWidth = 320, kHeight = 240;

// A still scene with a flat thing on the floor, whose markings are painted in the image of a registered
// colour camera.
class Rig {
 public:
  Rig() : camera_(calibration()), renderer_(camera_), memory_([&](Bump& b) { segmenter_.bind(b, camera_); }) {
    segmenter_.configure(camera_);
  }
  // Stripes shifted by `shift` pixels on the thing; brightness times `gain` right of column `shadow_from`.
  bool released(int shift, double gain = 1.0, int shadow_from = 0) {
    const auto& frame = renderer_.render({.boxes = {{.y = 1.6, .width = 0.4, .depth = 0.4}}});
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u)
        paint(u, v, frame.mask[static_cast<std::size_t>(v * kWidth + u)], shift,
              u >= shadow_from ? gain : 1.0);
    FrameInput input;
    input.depth = {frame.raw.data(), kWidth, kHeight};
    input.color = {rgb_.data(), 3 * kWidth, kHeight};
    input.color_is_new = true;
    segmenter_.preprocess(input);
    return segmenter_.segment(input, {}).has_released;
  }

 private:
  static Calibration calibration() {
    Calibration c = test::kinect_calibration(kWidth, kHeight);
    c.has_color = c.color_registered = true;
    return c;
  }
  void paint(int u, int v, int label, int shift, double gain) {
    const int stripe = (u + v / 2 + (label == 1 ? shift : 0)) / 6 % 2;
    noise_ = noise_ * 1664525u + 1013904223u;
    const double value = (stripe == 0 ? 90 : 170) * gain + static_cast<double>(noise_ >> 28) - 8;
    for (int k = 0; k < 3; ++k)
      rgb_[static_cast<std::size_t>(3 * (v * kWidth + u) + k)] = static_cast<std::uint8_t>(value);
  }

  Calibration camera_;
  test::SceneCamera renderer_;
  Segmenter segmenter_;
  test::BoundMemory memory_;
  std::vector<std::uint8_t> rgb_ = std::vector<std::uint8_t>(3 * kWidth * kHeight, 0);
  std::uint32_t noise_ = 3;
};

}  // namespace

TEST_GROUP(ProtoTexture){};

TEST(ProtoTexture, MarkingsThatMoveReleaseAThingOfUnchangedShape) {
  Rig rig;
  for (int i = 0; i < 20; ++i) CHECK_FALSE(rig.released(0));
  bool released = false;
  for (int i = 0; i < 10; ++i) released |= rig.released(i);
  CHECK(released);
}

TEST(ProtoTexture, ExposureAndShadowsDoNot) {
  Rig rig;
  for (int i = 0; i < 20; ++i) CHECK_FALSE(rig.released(0));
  for (int i = 0; i < 20; ++i) CHECK_FALSE(rig.released(0, 1.0 + 0.02 * i));
  for (int i = 0; i < 20; ++i) CHECK_FALSE(rig.released(0, 0.6));
  for (int i = 0; i < 60; ++i)
    CHECK_FALSE(rig.released(0, 0.6, 200 - 2 * i));  // a shadow's edge passes over it
}
