#include "algo/segmentation/segmenter.hpp"

#include <CppUTest/TestHarness.h>

#include <vector>

#include "tests/support/bound.hpp"
#include "tests/support/test_scene.hpp"

using namespace st;

namespace {

class Rig {
 public:
  // `blind`: columns at the right edge that have no readings, as a Kinect's have none.
  explicit Rig(int width = 320, int blind = 0)
      : blind_(blind),
        camera_(test::kinect_calibration(width, width * 3 / 4)),
        renderer_(camera_),
        memory_([&](Bump& b) { segmenter_.bind(b, camera_); }),
        owner_(static_cast<std::size_t>(camera_.depth.width * camera_.depth.height), 0) {
    segmenter_.configure(camera_);
  }
  const Segmentation& step(const test::TestScene& scene) {
    frame_ = &renderer_.render(scene);
    const int width = camera_.depth.width, height = camera_.depth.height;
    raw_ = frame_->raw;
    for (int v = 0; v < height; ++v)
      for (int u = width - blind_; u < width; ++u) raw_[static_cast<std::size_t>(v * width + u)] = 2047;
    FrameInput input;
    input.depth = {raw_.data(), width, height};
    segmenter_.preprocess(input);
    out_ = &segmenter_.segment(input, {owner_.data(), camera_.depth.width, camera_.depth.height});
    return *out_;
  }
  // Intersection over union of all labels with what the truth calls `label` and the sensor sees.
  double overlap(std::uint8_t label) const {
    int both = 0, either = 0;
    for (std::size_t i = 0; i < frame_->mask.size(); ++i) {
      const bool is = frame_->mask[i] == label && frame_->raw[i] < 2047, said = out_->labels.data[i] != 0;
      both += is && said ? 1 : 0;
      either += is || said ? 1 : 0;
    }
    return either > 0 ? static_cast<double>(both) / either : 0;
  }
  void own_what_is_labelled() {
    for (std::size_t i = 0; i < owner_.size(); ++i) owner_[i] = out_->labels.data[i];
  }
  bool overflowed() const { return memory_.overflowed(); }
  const Segmenter& segmenter() const { return segmenter_; }
  std::uint64_t hash() const {
    std::uint64_t h = 1469598103934665603u;
    for (int i = 0; i < out_->labels.pixels(); ++i) h = (h ^ out_->labels.data[i]) * 1099511628211u;
    return h;
  }

 private:
  int blind_;
  std::vector<std::uint16_t> raw_;
  Calibration camera_;
  test::SceneCamera renderer_;
  Segmenter segmenter_;
  test::BoundMemory memory_;
  std::vector<std::uint8_t> owner_;
  const test::RenderedScene* frame_ = nullptr;
  const Segmentation* out_ = nullptr;
};

// A robot among furniture.
test::TestScene lab(double robot_x) {
  return {.boxes = {{.x = robot_x, .y = 2.0},
                    {.x = 0.8, .y = 3.0, .width = 0.5, .height = 0.6},
                    {.x = -0.9, .y = 1.4, .height = 0.3}}};
}

}  // namespace

TEST_GROUP(Segmenter){};

TEST(Segmenter, AnEmptySceneOfAThousandFramesHasNoSegment) {
  Rig rig(160);
  CHECK_FALSE(rig.overflowed());
  std::size_t segments = 0, released = 0;
  for (int i = 0; i < 1000; ++i) {
    const Segmentation& s = rig.step(lab(-0.3));
    segments += s.segments.size();
    released += s.has_released ? 1u : 0u;
  }
  UNSIGNED_LONGS_EQUAL(0, segments);
  UNSIGNED_LONGS_EQUAL(0, released);
}

TEST(Segmenter, ARobotThatStoodFromTheFirstFrameIsWholeSoonAfterItMoves) {
  for (int width : {640, 320}) {
    Rig rig(width);
    for (int i = 0; i < 20; ++i) UNSIGNED_LONGS_EQUAL(0, rig.step(lab(-0.3)).segments.size());
    int whole_at = -1, released_at = -1;
    for (int i = 1; i <= 20; ++i) {  // 0.2 m/s at 30 Hz
      const Segmentation& s = rig.step(lab(-0.3 + 0.0067 * i));
      if (s.has_released) {
        released_at = i;
        CHECK(s.segments.size() == 1 && s.segments[0].from_background);
        DOUBLES_EQUAL(0.09, static_cast<double>(s.released.top_m), 0.02);
        int rest = 0;
        for (int k = 0; k < s.released_code.pixels(); ++k) rest += s.released_code.data[k] != 0 ? 1 : 0;
        LONGS_EQUAL(s.released.pixels, rest);
      }
      if (whole_at < 0 && rig.overlap(1) > 0.85) whole_at = i;
      if (whole_at >= 0) CHECK(rig.overlap(1) > 0.8);
      if (released_at < 0) UNSIGNED_LONGS_EQUAL(0, s.segments.size());  // no slivers before
      rig.own_what_is_labelled();
    }
    CHECK(released_at > 0 && released_at <= 9);
    CHECK(whole_at > 0 && whole_at <= 9);
  }
}

TEST(Segmenter, WhatPassesInFrontReleasesNothing) {
  Rig rig;
  for (int i = 0; i < 12; ++i) rig.step(lab(-0.3));
  bool seen = false;
  for (int i = 0; i < 40; ++i) {
    test::TestScene scene = lab(-0.3);
    scene.boxes.push_back({.x = -1.2 + 0.05 * i, .y = 1.4, .width = 0.1, .depth = 0.1, .height = 0.6});
    const Segmentation& s = rig.step(scene);
    CHECK_FALSE(s.has_released);
    seen |= rig.overlap(4) > 0.7;
  }
  CHECK(seen);
}

TEST(Segmenter, TwoMoversAreTwoSegments) {
  Rig rig;
  auto scene = [](double way) {
    return test::TestScene{.boxes = {{.x = -0.6 + way, .y = 2.0}, {.x = 0.6 - way, .y = 1.8}}};
  };
  for (int i = 0; i < 12; ++i) rig.step(scene(0));
  for (int i = 0; i < 25; ++i) rig.step(scene(0.01 * i));
  const Segmentation& s = rig.step(scene(0.25));
  UNSIGNED_LONGS_EQUAL(2, s.segments.size());
  for (const Segment& g : s.segments) {
    DOUBLES_EQUAL(0.09, static_cast<double>(g.top_m), 0.02);
    DOUBLES_EQUAL(0.4, static_cast<double>(g.extent_m), 0.15);
    CHECK_FALSE(g.touches_border);
  }
}

TEST(Segmenter, TheEdgeOfTheViewIsWhereReadingsEnd) {
  Rig rig(160, 12);
  for (int i = 0; i < 12; ++i) rig.step(lab(-0.3));
  const Segmentation& s = rig.step(lab(-0.3));
  CHECK(s.background_ready);
  LONGS_EQUAL(0, s.view.u0);
  LONGS_EQUAL(160 - 12, s.view.u1);
  LONGS_EQUAL(120, s.view.v1);
  const Rect view{0, 0, 100, 80};
  CHECK(is_cut({90, 20, 99, 40}, view));
  CHECK(is_cut({40, 0, 60, 40}, view));
  CHECK_FALSE(is_cut({40, 10, 60, 40}, view));
}

TEST(Segmenter, AnOwnedRobotNeverMeltsAndAMovedChairDoes) {
  Rig owned, unowned;
  for (Rig* rig : {&owned, &unowned}) {
    for (int i = 0; i < 12; ++i) rig->step(lab(-0.3));
    for (int i = 0; i < 30; ++i) {
      rig->step(lab(-0.3 + 0.01 * i));
      if (rig == &owned) rig->own_what_is_labelled();
    }
    for (int i = 0; i < 150; ++i) {
      rig->step(lab(0));
      if (rig == &owned) rig->own_what_is_labelled();
    }
  }
  CHECK(owned.overlap(1) > 0.8);
  UNSIGNED_LONGS_EQUAL(0, unowned.step(lab(0)).segments.size());
  // What has become background again is a thing again: it is released when it moves on.
  bool released = false;
  for (int i = 0; i < 30; ++i) unowned.step(lab(0));
  for (int i = 0; i < 15; ++i) released |= unowned.step(lab(0.01 * i)).has_released;
  CHECK(released);
}

TEST(Segmenter, WithoutAFloorForegroundIsStillFound) {
  Rig rig;
  test::TestScene scene{.pitch_rad = 0.0, .floor = false, .wall_y = 1.5};
  for (int i = 0; i < 12; ++i) rig.step(scene);
  scene.boxes.push_back({.x = 0.1, .y = 1.0, .z = 1.1, .width = 0.1, .depth = 0.1, .height = 0.2});
  const Segmentation& s = rig.step(scene);
  CHECK_FALSE(s.floor.found);
  UNSIGNED_LONGS_EQUAL(1, s.segments.size());
  CHECK(rig.overlap(1) > 0.8);
  CHECK_FALSE(s.segments[0].has_height);
}

TEST(Segmenter, AMovedCameraStartsAnew) {
  Rig rig;
  for (int i = 0; i < 20; ++i) rig.step(lab(-0.3));
  test::TestScene other = lab(-0.3);
  other.pitch_rad = 0.35;
  bool restarted = false;
  for (int i = 0; i < 30; ++i) restarted |= rig.step(other).restarted;
  CHECK(restarted);
  const Segmentation& s = rig.step(other);
  CHECK(s.background_ready && s.floor.found);
  UNSIGNED_LONGS_EQUAL(0, s.segments.size());
}

TEST(Segmenter, SameFramesSameResult) {
  Rig a(160), b(160);
  for (int i = 0; i < 30; ++i) {
    a.step(lab(-0.3 + 0.005 * i));
    b.step(lab(-0.3 + 0.005 * i));
    CHECK(a.hash() == b.hash());
  }
}

TEST(Segmenter, InvalidPixelsAreCountedAndNeverLabelled) {
  Rig rig;
  for (int i = 0; i < 12; ++i) rig.step(lab(-0.3));
  const Segmentation& s = rig.step(lab(0.1));
  std::uint32_t invalid = 0;
  for (int i = 0; i < s.labels.pixels(); ++i) {
    if (s.depth.code.data[i] != 0) continue;
    ++invalid;
    LONGS_EQUAL(0, s.labels.data[i]);
  }
  UNSIGNED_LONGS_EQUAL(invalid, s.depth.invalid_pixels);
  CHECK(invalid > 0);
}
