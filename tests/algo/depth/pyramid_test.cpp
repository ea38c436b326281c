#include "algo/depth/pyramid.hpp"

#include <cmath>
#include <span>
#include <vector>

#include "tests/support/bound.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;

namespace {

Calibration small_camera(DepthEncoding encoding) {
  Calibration c;
  c.depth = {42, 30, 40, 40, 20.5, 14.5, {0, 0, 0, 0, 0}};
  c.encoding = encoding;
  c.depth_scale = 5000;
  return c;
}

struct Filled {
  explicit Filled(const Calibration& c)
      : memory([&](Bump& bump) {
          tables.bind(bump, c);
          pyramid.bind(bump, Pinhole::of(c.depth));
        }),
        stored(42 * 30, 0) {
    tables.configure(c);
  }
  std::uint32_t fill() { return fill_pyramid(tables, {stored.data(), 42, 30}, pyramid); }

  DepthTables tables;
  DepthPyramid pyramid;
  BoundMemory memory;
  std::vector<std::uint16_t> stored;
};

}  // namespace

TEST_GROUP(DepthPyramid){};

TEST(DepthPyramid, StoredValuesBecomeTheMetresOfTheTables) {
  for (const DepthEncoding encoding : {DepthEncoding::kScaled16, DepthEncoding::kRaw11}) {
    Filled f(small_camera(encoding));
    for (std::size_t i = 0; i < f.stored.size(); ++i) f.stored[i] = static_cast<std::uint16_t>(37 * i);
    f.stored.back() = 65535;
    std::uint32_t invalid = 0;
    for (std::size_t i = 0; i < f.stored.size(); ++i)
      invalid += f.stored[i] >= f.tables.z_of_stored().size() || !(f.tables.z_of_stored()[f.stored[i]] > 0);
    UNSIGNED_LONGS_EQUAL(invalid, f.fill());
    for (std::size_t i = 0; i < f.stored.size(); ++i) {
      const bool known = f.stored[i] < f.tables.z_of_stored().size();
      DOUBLES_EQUAL(known ? f.tables.z_of_stored()[f.stored[i]] : 0, f.pyramid.levels[0].z.data[i], 1e-5);
    }
  }
}

TEST(DepthPyramid, ACoarsePixelIsTheMeanOfTheNearestSurface) {
  Filled f(small_camera(DepthEncoding::kScaled16));
  for (std::uint16_t& s : f.stored) s = 10000;                          // 2 m
  f.stored[0] = 5000, f.stored[1] = 5050;                               // an edge: 1 m and 1.01 m before it
  f.stored[2] = f.stored[3] = f.stored[42 + 2] = 0;                     // one reading in four
  f.stored[4] = f.stored[5] = f.stored[42 + 4] = f.stored[42 + 5] = 0;  // none
  f.fill();
  const ImageView<float>& half = f.pyramid.levels[1].z;
  LONGS_EQUAL(21, half.width);
  DOUBLES_EQUAL(1.005, half(0, 0), 1e-6);
  DOUBLES_EQUAL(2.0, half(1, 0), 1e-6);
  DOUBLES_EQUAL(0.0, half(2, 0), 0);
  for (int v = 1; v < half.height; ++v)
    for (int u = 0; u < half.width; ++u) DOUBLES_EQUAL(2.0, half(u, v), 1e-6);
  LONGS_EQUAL(10, f.pyramid.levels[2].z.width);
  DOUBLES_EQUAL(f.pyramid.levels[0].camera.fx / 4, f.pyramid.levels[2].camera.fx, 1e-6);
}

TEST(DepthPyramid, AFrameOfAnotherSizeHasNoReading) {
  Filled f(small_camera(DepthEncoding::kScaled16));
  for (std::uint16_t& s : f.stored) s = 10000;
  UNSIGNED_LONGS_EQUAL(42 * 30, fill_pyramid(f.tables, {f.stored.data(), 30, 42}, f.pyramid));
  for (const DepthPyramid::Level& level : f.pyramid.levels)
    for (int i = 0; i < level.z.pixels(); ++i) DOUBLES_EQUAL(0, level.z.data[i], 0);
}

TEST(DepthPyramid, ACorrectionAddsToTheInverseOfDepth) {
  for (const DepthEncoding encoding : {DepthEncoding::kScaled16, DepthEncoding::kRaw11}) {
    Calibration c = small_camera(encoding);
    c.correction.columns = c.correction.rows = 2;
    for (int i = 0; i < 4; ++i) c.correction.steps[i] = 3.0f;
    Filled f(c);
    const std::uint16_t value = encoding == DepthEncoding::kRaw11 ? 900 : 10000;
    f.stored[0] = value;
    f.fill();
    const double plain = static_cast<double>(f.tables.z_of_stored()[value]);
    DOUBLES_EQUAL(1 / (1 / plain + 3 / c.raw_a), static_cast<double>(f.pyramid.levels[0].z.data[0]), 1e-5);
    DOUBLES_EQUAL(0, f.pyramid.levels[0].z.data[1], 0);
  }
}

// The largest correction that a camera file may hold would turn a far reading inside out.
TEST(DepthPyramid, WhatACorrectionMovesOutOfRangeIsNoReading) {
  for (const float steps : {-64.0f, 64.0f}) {
    Calibration c = small_camera(DepthEncoding::kRaw11);
    c.correction.columns = c.correction.rows = 2;
    for (int i = 0; i < 4; ++i) c.correction.steps[i] = steps;
    Filled f(c);
    for (std::size_t i = 0; i < f.stored.size(); ++i) f.stored[i] = static_cast<std::uint16_t>(400 + i % 700);
    std::uint32_t none = f.fill();
    for (const float z : std::span<const float>(f.pyramid.levels[0].z.data, f.stored.size())) {
      CHECK(z == 0 || (z >= 0.35f && z <= 10.0f));
      none -= z == 0 ? 1 : 0;
    }
    UNSIGNED_LONGS_EQUAL(0, none);
  }
}
