#include "algo/volume/surface_points.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <vector>

#include "tests/algo/volume/analytic_view.hpp"

using namespace st;
using namespace st::test;

TEST_GROUP(SurfacePoints) {
  Bench bench{64};
  std::mt19937 random{2};
  std::vector<Vec3f> points = std::vector<Vec3f>(40000);

  void learn(const Solid& solid) {
    bench.volume.reset(0.006f, 0.024f, {0, 0, 0});
    for (int i = 0; i < 8; ++i) bench.fuse(render(solid, looking_at(1.0, 0.8 * i, 0.5), {}, random));
  }
};

TEST(SurfacePoints, LieOnTheSurfaceAndOnTheVolumesZeroLevel) {
  const Disc disc(0.12, 0.05);
  learn(disc);
  const std::size_t count = surface_points(bench.volume, points);
  CHECK(count > 2000);
  CHECK(count < points.size());
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const SdfSample there = sample(bench.volume, points[i]);
    if (there.valid) DOUBLES_EQUAL(0, there.sdf_m, 1e-5);
    sum += std::fabs(disc.distance(to_double(points[i])));
  }
  CHECK(sum / static_cast<double>(count) < 0.001);
}

TEST(SurfacePoints, AreEveryCrossingBetweenTwoVoxels) {
  learn(Disc(0.12, 0.05));
  const Volume& v = bench.volume;
  const auto crossing = [&v](std::size_t a, std::size_t b) {
    return v.tsdf[a] != kUnseen && v.tsdf[b] != kUnseen && (v.tsdf[a] < 0) != (v.tsdf[b] < 0);
  };
  std::size_t expected = 0;
  for (int z = 0; z < v.side; ++z)
    for (int y = 0; y < v.side; ++y)
      for (int x = 0; x < v.side; ++x) {
        const std::size_t at = v.index(x, y, z);
        if (x + 1 < v.side && crossing(at, v.index(x + 1, y, z))) ++expected;
        if (y + 1 < v.side && crossing(at, v.index(x, y + 1, z))) ++expected;
        if (z + 1 < v.side && crossing(at, v.index(x, y, z + 1))) ++expected;
      }
  UNSIGNED_LONGS_EQUAL(expected, surface_points(v, points));
}

TEST(SurfacePoints, TooManyAreThinnedEvenly) {
  learn(Disc(0.12, 0.05));
  const std::size_t all = surface_points(bench.volume, points);
  std::vector<Vec3f> few(all / 3);
  const std::size_t count = surface_points(bench.volume, few);
  CHECK(count > all / 5);
  CHECK(count <= few.size());
  const std::size_t every = (all + few.size() - 1) / few.size();
  for (std::size_t i = 0; i < count; ++i) CHECK(norm(few[i] - points[i * every]) == 0);
}

TEST(SurfacePoints, AnEmptyVolumeHasNone) {
  bench.volume.reset(0.006f, 0.024f, {0, 0, 0});
  UNSIGNED_LONGS_EQUAL(0, surface_points(bench.volume, points));
}
