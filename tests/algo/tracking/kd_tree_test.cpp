#include "algo/tracking/kd_tree.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/bound.hpp"

using namespace st;
using namespace st::test;

namespace {

float distance2(const Vec3f& a, const Vec3f& b) { return dot(a - b, a - b); }

float by_looking_at_all(const std::vector<Vec3f>& points, const Vec3f& p) {
  float least = 1e30f;
  for (const Vec3f& q : points) least = std::min(least, distance2(q, p));
  return least;
}

}  // namespace

TEST_GROUP(KdTree) {
  KdTree tree;
  BoundMemory memory{[this](Bump& bump) { tree.bind(bump, KdTree::kMostPoints); }};
  std::mt19937 random{3};

  float uniform() { return static_cast<float>(random()) / 4294967296.0f; }
  Vec3f anywhere(float size_m) {
    const float x = uniform(), y = uniform(), z = uniform();
    return {size_m * x, size_m * y, size_m * z};
  }
  void build(const std::vector<Vec3f>& points) {
    std::copy(points.begin(), points.end(), tree.room().begin());
    tree.build(points.size());
  }
  // The distance must be the least one to the bit: the tree leaves out nothing that could be closer.
  void check_like_all(const std::vector<Vec3f>& points, int queries, float size_m) {
    build(points);
    for (int i = 0; i < queries; ++i) {
      const Vec3f p = anywhere(size_m);
      const KdTree::Nearest found = tree.nearest(p);
      CHECK(found.distance2_m2 == by_looking_at_all(points, p));
      CHECK(found.distance2_m2 == distance2(tree.points()[found.index], p));
    }
  }
};

TEST(KdTree, FindsWhatLookingAtAllPointsFinds) {
  for (const std::size_t count : {1u, 2u, 3u, 8u, 9u, 10u, 17u, 100u, 1000u, 5000u}) {
    std::vector<Vec3f> points(count);
    for (Vec3f& p : points) p = anywhere(0.5f);
    check_like_all(points, 300, 0.6f);
  }
}

TEST(KdTree, FindsItOnSurfacesLinesAndAmongEqualPoints) {
  std::vector<Vec3f> plane(2000), line(500), equal(300, Vec3f{0.1f, 0.2f, 0.3f}), grid;
  for (Vec3f& p : plane) p = anywhere(0.5f), p.z = 0.2f;
  for (Vec3f& p : line) p = anywhere(0.5f), p.x = p.y = 0.1f;
  for (int i = 0; i < 1000; ++i)
    grid.push_back(
        Vec3f{static_cast<float>(i % 10), static_cast<float>(i / 10 % 10), static_cast<float>(i / 100)} *
        0.05f);
  for (const std::vector<Vec3f>& points : {plane, line, equal, grid}) check_like_all(points, 300, 0.6f);
}

TEST(KdTree, HoldsAsManyPointsAsItSays) {
  std::vector<Vec3f> points(KdTree::kMostPoints);
  for (Vec3f& p : points) p = anywhere(0.5f);
  check_like_all(points, 50, 0.5f);
}

TEST(KdTree, AnEmptyOneFindsNothing) {
  tree.build(0);
  CHECK(tree.nearest({0, 0, 0}).distance2_m2 > 1e29f);
}
