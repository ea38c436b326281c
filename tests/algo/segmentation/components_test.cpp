#include "algo/segmentation/components.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/support/bound.hpp"
#include "tests/support/test_scene.hpp"

using namespace st;

namespace {

struct Fixture {
  Components components;
  test::BoundMemory memory;
  ImageView<std::uint16_t> cells;
  Fixture(int width, int height) : memory([&](Bump& b) { components.bind(b, width, height); }) {
    cells = components.begin();
  }
  void fill(const Rect& r, std::uint16_t q) {
    for (int v = r.v0; v < r.v1; ++v)
      for (int u = r.u0; u < r.u1; ++u) cells(u, v) = q;
  }
  int label() {
    components.label(1);
    return components.select(1, 0, 64);
  }
};

}  // namespace

TEST_GROUP(Components){};

TEST(Components, AForkJoinsItsTines) {
  Fixture f(64, 40);
  for (int u = 2; u < 60; u += 4) f.fill({u, 5, u + 1, 30}, 1000);
  f.fill({2, 30, 59, 31}, 1000);
  LONGS_EQUAL(1, f.label());
  UNSIGNED_LONGS_EQUAL(15 * 25 + 57, f.components.selected(1).cells);
}

TEST(Components, CornersTouchAndGapsDoNot) {
  Fixture f(32, 32);
  f.fill({2, 2, 4, 4}, 1000);
  f.fill({4, 4, 6, 6}, 1000);  // diagonal
  f.fill({8, 4, 9, 6}, 1000);  // two columns away
  LONGS_EQUAL(2, f.label());
}

TEST(Components, ADepthStepSeparates) {
  Fixture f(32, 32);
  f.fill({2, 2, 20, 10}, 1000);
  f.fill({2, 10, 20, 20}, 1100);  // 25 cm nearer at 2.5 m
  f.fill({20, 2, 30, 20}, 1110);
  LONGS_EQUAL(2, f.label());
  Fixture slope(32, 32);
  for (int u = 0; u < 32; ++u) slope.fill({u, 0, u + 1, 8}, static_cast<std::uint16_t>(1000 + 15 * u));
  LONGS_EQUAL(1, slope.label());
}

TEST(Components, LargestFirstByMetricAreaNotByPixels) {
  Fixture f(64, 32);
  f.fill({0, 0, 20, 10}, 4000);   // 200 cells at 0.7 m
  f.fill({30, 0, 40, 10}, 1000);  // 100 cells at 2.8 m: four times the area
  LONGS_EQUAL(2, f.label());
  UNSIGNED_LONGS_EQUAL(100, f.components.selected(1).cells);
  const Calibration c = test::kinect_calibration(64, 32);
  DepthTables tables;
  const test::BoundMemory memory([&](Bump& b) { tables.bind(b, c); });
  tables.configure(c);
  const double side = 2.7639152 / c.depth.fx * 100;  // cm a pixel at code 1000
  DOUBLES_EQUAL(100 * side * side, static_cast<double>(f.components.area_cm2(1, tables, 1)), 3.0);
}

TEST(Components, TooManyRunsAreRefusedAndCounted) {
  Fixture f(640, 480);
  for (int v = 0; v < 480; v += 2)
    for (int u = 0; u < 640; u += 2) f.cells(u, v) = 1000;
  f.label();
  UNSIGNED_LONGS_EQUAL(240 * 320 - Components::kMaxRuns, f.components.refused_runs());
}

TEST(Components, OnlyTheLargestAreSelected) {
  Fixture f(320, 8);
  for (int i = 0; i < 40; ++i) f.fill({8 * i, 0, 8 * i + 1 + i % 7, 1}, 1000);
  f.components.label(1);
  LONGS_EQUAL(5, f.components.select(1, 0, 5));
  for (int n = 1; n <= 5; ++n) UNSIGNED_LONGS_EQUAL(7, f.components.selected(n).cells);
}
