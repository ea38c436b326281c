// A real recording: a plush squirrel and a lump stand on a table from the first frame; a person reaches in
// and takes hold of both after about two seconds.
#include <CppUTest/TestHarness.h>

#include <cstdio>

#include "algo/segmentation/segmenter.hpp"
#include "tests/support/bound.hpp"
#include "tests/support/recorded_depth.hpp"

using namespace st;

TEST_GROUP(ToyTable){};

TEST(ToyTable, WhatIsTakenHoldOfIsReleasedAndTheTableIsNot) {
  Calibration c;
  c.depth = {320, 240, 275.0, 275.0, 160.0, 120.0, {0, 0, 0, 0, 0}};
  c.encoding = DepthEncoding::kScaled16;
  Segmenter segmenter;
  const test::BoundMemory memory([&](Bump& b) { segmenter.bind(b, c); });
  segmenter.configure(c);
  int squirrel_at = -1, lump_at = -1;
  for (int i = 0; i < 100; ++i) {
    char name[48];
    std::snprintf(name, sizeof name, "/toy-table/depth/%06d.png", i);
    const auto depth = test::read_depth_png(test::data_folder() + name, 320, 240);
    if (depth.empty()) {
      std::printf("skipped: no toy-table recording in %s\n", test::data_folder().c_str());
      return;
    }
    FrameInput input;
    input.depth = {depth.data(), 320, 240};
    segmenter.preprocess(input);
    const Segmentation& s = segmenter.segment(input, {});
    if (i == 20) {
      CHECK(s.floor.found);
      DOUBLES_EQUAL(0.379, s.floor.d, 0.01);  // the camera above the table
    }
    if (!s.has_released) continue;
    CHECK(s.released.pixels < 8000);  // neither the table nor the person and the table in one
    const Rect& box = s.released.box;
    if (box.u0 < 180 && box.u1 > 200 && box.v0 < 60 && box.v1 > 150) squirrel_at = i;
    if (box.u0 < 100 && box.u1 > 120 && box.v0 > 90) lump_at = i;
  }
  CHECK(squirrel_at >= 60 && squirrel_at <= 75);
  CHECK(lump_at >= 60 && lump_at <= 75);
}
