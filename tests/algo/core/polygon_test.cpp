#include "algo/core/polygon.hpp"

#include <CppUTest/TestHarness.h>

using namespace st;

TEST_GROUP(Polygon){};

// An L, so that it is not convex; either way round.
TEST(Polygon, KnowsInsideFromOutside) {
  const PlanePoint left[] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};
  const PlanePoint right[] = {{0, 2}, {1, 2}, {1, 1}, {3, 1}, {3, 0}, {0, 0}};
  for (const std::span<const PlanePoint> corners :
       {std::span<const PlanePoint>(left), std::span<const PlanePoint>(right)}) {
    CHECK(is_inside(corners, 0.5, 1.5));
    CHECK(is_inside(corners, 2.5, 0.5));
    CHECK_FALSE(is_inside(corners, 2.5, 1.5));
    CHECK_FALSE(is_inside(corners, -0.1, 0.5));
    CHECK_FALSE(is_inside(corners, 0.5, 2.1));
  }
}
