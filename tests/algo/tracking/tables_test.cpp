#include <set>

#include <CppUTest/TestHarness.h>

#include "algo/tracking/point_table.hpp"
#include "algo/tracking/view_table.hpp"
#include "tests/algo/tracking/painted_ellipsoid.hpp"
#include "tests/support/bound.hpp"

using namespace st;
using namespace st::test;

namespace {

std::vector<ObservedPoint> numbered(std::size_t count) {
  std::vector<ObservedPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i].p.x = static_cast<float>(i);
  return points;
}

}  // namespace

TEST_GROUP(PointTable) {
  PointTable table;
  BoundMemory memory{[this](Bump& b) { table.bind(b); }};
};

TEST(PointTable, KeepsEveryPointOnceWhenThereIsRoom) {
  const std::vector<ObservedPoint> points = numbered(777);
  arrange_points(points, PointTable::kMost, table);
  UNSIGNED_LONGS_EQUAL(777, table.count);
  const std::set<float> seen(table.x.begin(), table.x.begin() + 777);
  UNSIGNED_LONGS_EQUAL(777, seen.size());
  DOUBLES_EQUAL(1.0, table.thinning(777), 1e-6);
}

TEST(PointTable, ThinsEvenlyAndNeverBeyondItsRoom) {
  const std::vector<ObservedPoint> points = numbered(20000);
  arrange_points(points, 1u << 20, table);
  UNSIGNED_LONGS_EQUAL(PointTable::kMost, table.count);
  const std::set<float> seen(table.x.begin(), table.x.begin() + static_cast<int>(table.count));
  UNSIGNED_LONGS_EQUAL(table.count, seen.size());
  float before = -4;
  for (const float x : seen) {
    CHECK_COMPARE(x - before, <=, 4.0f);
    before = x;
  }
  DOUBLES_EQUAL(20000.0 / 1500, table.thinning(1500), 1e-3);
}

TEST(PointTable, APrefixIsSpreadOverTheWholeObject) {
  const std::vector<ObservedPoint> points = numbered(4001);
  arrange_points(points, PointTable::kMost, table);
  UNSIGNED_LONGS_EQUAL(4001, table.prefix(3000));
  UNSIGNED_LONGS_EQUAL(2001, table.prefix(2001));
  UNSIGNED_LONGS_EQUAL(1001, table.prefix(600));
  UNSIGNED_LONGS_EQUAL(501, table.prefix(1));
  for (const std::size_t wanted : {1u, 600u, 2001u}) {
    const std::size_t length = table.prefix(wanted);
    const std::set<float> seen(table.x.begin(), table.x.begin() + static_cast<int>(length));
    float before = -8;
    for (const float x : seen) {
      CHECK_COMPARE(x - before, <=, 8.0f);
      before = x;
    }
    DOUBLES_EQUAL(4000, before, 8);
  }
}

TEST_GROUP(ViewTable) {
  PaintedEllipsoid thing;
  Pose at{rotation_from_vector({0.3, 0.5, -0.2}), {0.05, -0.03, 1.3}};
  PaintedView model{thing, at, {90, 50, 250, 190}};
  ViewTable table;
  BoundMemory memory{[this](Bump& b) { table.bind(b, 320, 240); }};
};

TEST(ViewTable, HoldsWhatTheViewHolds) {
  build_view_table(model.view, table);
  int surface = 0, colored = 0;
  for (int v = 40; v < 200; ++v) {
    for (int u = 80; u < 260; ++u) {
      const ViewPixel& pixel = table.at(u, v);
      DOUBLES_EQUAL(model.view.z(u, v), pixel.z, 0);
      if (!(pixel.z > 0)) continue;
      ++surface;
      const Vec3f n = unpack_normal(model.view.maps.normal[model.view.maps.at(u, v)]);
      DOUBLES_EQUAL(n.x, pixel.nx / kNormalScale, 1e-4);
      DOUBLES_EQUAL(n.z, pixel.nz / kNormalScale, 1e-4);
      const auto grey = [&](int x, int y) {
        return luminance_of(model.view.maps.color[model.view.maps.at(x, y)]);
      };
      if (pixel.luminance == kNoColor) continue;
      ++colored;
      DOUBLES_EQUAL(grey(u, v), pixel.luminance / kLuminanceScale, 0.01);
    }
  }
  CHECK_COMPARE(surface, >, 1000);
  CHECK_COMPARE(colored * 10, >, surface * 8);
  CHECK_COMPARE(colored, <, surface);
}

TEST(ViewTable, BesideAMissingColorThereIsNone) {
  model.color[model.view.maps.at(170, 110)] = 0;
  build_view_table(model.view, table);
  CHECK(table.at(168, 110).luminance != kNoColor);
  for (const auto& [u, v] : {std::pair{170, 110}, {169, 110}, {171, 110}, {170, 109}, {170, 111}}) {
    CHECK(table.at(u, v).z > 0);
    LONGS_EQUAL(kNoColor, table.at(u, v).luminance);
  }
}
