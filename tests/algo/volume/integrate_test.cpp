#include "algo/volume/integrate.hpp"

#include <algorithm>

#include "algo/core/simd.hpp"
#include "tests/algo/volume/dense_oracle.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

// Mean signed and mean absolute distance between the zero level and the solid, over cells that hold the
// level.
struct SurfaceError {
  double bias_m = 0, mean_m = 0;
  int points = 0;
};
SurfaceError surface_error(const Volume& v, const Solid& solid) {
  SurfaceError e;
  for (int z = 0; z + 1 < v.side; ++z)
    for (int y = 0; y + 1 < v.side; ++y)
      for (int x = 0; x + 1 < v.side; ++x)
        for (int a = 0; a < 3; ++a) {
          const std::size_t i = v.index(x, y, z), j = v.index(x + (a == 0), y + (a == 1), z + (a == 2));
          const float p = v.tsdf[i], q = v.tsdf[j];
          if (v.tsdf[i] == kUnseen || v.tsdf[j] == kUnseen || (p < 0) == (q < 0)) continue;
          Vec3 at = to_double(v.position(x, y, z));
          at[a] += static_cast<double>(v.voxel_m * p / (p - q));
          const double d = solid.distance(at);
          e.bias_m += d;
          e.mean_m += std::fabs(d);
          ++e.points;
        }
  e.bias_m /= e.points;
  e.mean_m /= e.points;
  return e;
}

Pose around(double distance_m, int i) { return looking_at(distance_m, 0.7 * i, 0.35 + 0.05 * (i % 7)); }

}  // namespace

TEST_GROUP(Integrate) {
  std::mt19937 random{7};
  Rendering how;

  void teardown() override { select_simd(nullptr); }

  SurfaceError fused_error(const Solid& solid, int views, double distance_m, double noise,
                           bool noise_aware = true) {
    Bench bench(96);
    bench.volume.reset(0.004f, choose_truncation_m(0.004f, 0.004f), {0, 0, 0});
    how.noise = noise;
    IntegrateOptions options;
    options.noise.noise_aware = noise_aware;
    options.noise.nominal_m = static_cast<float>(distance_m);
    for (int i = 0; i < views; ++i) bench.fuse(render(solid, around(distance_m, i), how, random), options);
    return surface_error(bench.volume, solid);
  }
};

TEST(Integrate, NoiselessViewsGiveTheSurfaceWithinAFractionOfAVoxel) {
  const SurfaceError sphere = fused_error(Sphere(0.12), 12, 1.0, 0);
  CHECK(sphere.points > 5000);
  CHECK(sphere.mean_m < 0.0004);
  CHECK(std::fabs(sphere.bias_m) < 0.0002);
  CHECK(fused_error(Box({0.1, 0.08, 0.06}), 12, 1.0, 0).mean_m < 0.0008);  // its edges are rounded off
  CHECK(fused_error(Disc(0.15, 0.045), 12, 1.0, 0).mean_m < 0.0004);
}

TEST(Integrate, NoiseAveragesOutWithTheRootOfTheNumberOfViews) {
  const Sphere sphere(0.12);
  // All views from the same direction, so that every voxel has exactly so many samples.
  const auto error = [&](int views) {
    Bench bench(96);
    bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
    how.noise = 1;
    for (int i = 0; i < views; ++i) bench.fuse(render(sphere, looking_at(1.2, 0, 0.5), how, random));
    return surface_error(bench.volume, sphere);
  };
  const SurfaceError one = error(1), four = error(4), sixteen = error(16);
  DOUBLES_EQUAL(2.0, one.mean_m / four.mean_m, 0.5);
  DOUBLES_EQUAL(4.0, one.mean_m / sixteen.mean_m, 1.2);
  CHECK(std::fabs(sixteen.bias_m) < 0.0005);
}

TEST(Integrate, WeightAndCountSaturateAndNeverWrap) {
  const Sphere sphere(0.12);
  Bench bench(64);
  bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
  const View view = render(sphere, looking_at(0.9, 0, 0.3), how, random);
  IntegrateOptions options;
  options.weight_cap = 100;
  std::vector<std::uint8_t> last(bench.volume.observations.begin(), bench.volume.observations.end());
  for (int i = 0; i < 300; ++i) {
    bench.fuse(view, options);
    for (std::size_t k = 0; k < last.size(); ++k) CHECK(bench.volume.observations[k] >= last[k]);
    last.assign(bench.volume.observations.begin(), bench.volume.observations.end());
  }
  UNSIGNED_LONGS_EQUAL(255, *std::max_element(last.begin(), last.end()));
  UNSIGNED_LONGS_EQUAL(200, *std::max_element(bench.volume.weight.begin(), bench.volume.weight.end()));
}

TEST(Integrate, ALongRunOfTheSameViewDoesNotDrift) {
  const Sphere sphere(0.12);
  Bench bench(64);
  bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
  const View view = render(sphere, looking_at(0.9, 0, 0.3), how, random);
  for (int i = 0; i < 5; ++i) bench.fuse(view);
  const SurfaceError early = surface_error(bench.volume, sphere);
  for (int i = 0; i < 400; ++i) bench.fuse(view);
  const SurfaceError late = surface_error(bench.volume, sphere);
  DOUBLES_EQUAL(early.bias_m, late.bias_m, 2e-6);
  LONGS_EQUAL(early.points, late.points);
}

TEST(Integrate, NoiseAwareWeightsBeatPlainOnesWhenDistanceVaries) {
  const Disc disc(0.15, 0.045);
  const auto error = [&](bool noise_aware) {
    std::mt19937 same(3);
    Bench bench(96);
    bench.volume.reset(0.004f, 0.03f, {0, 0, 0});
    how.noise = 1;
    IntegrateOptions options;
    options.noise.noise_aware = noise_aware;
    for (int i = 0; i < 16; ++i)
      bench.fuse(render(disc, looking_at(i % 2 == 0 ? 0.9 : 2.2, 0, 0.6), how, same), options);
    return surface_error(bench.volume, disc).mean_m;
  };
  const double aware = error(true), plain = error(false);
  CHECK(aware < 0.8 * plain);
}

TEST(Integrate, WhatLeavesIsCarvedAway) {
  const Sphere object(0.08);
  Bench bench(96);
  bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
  const Pose T = looking_at(0.9, 0, 0.4);
  // A hand (a small box between the object and the camera) is taken for a part of it for 30 frames.
  const Box hand({0.03, 0.03, 0.03});
  Pose T_hand = T;
  T_hand.t = T * Vec3{0.10, -0.05, 0.10};
  const View both = [&] {
    View object_view = render(object, T, how, random);
    const View hand_view = render(hand, T_hand, how, random);
    for (std::size_t i = 0; i < object_view.depth.size(); ++i)
      if (hand_view.owners[i] == 1 && hand_view.depth[i] < object_view.depth[i]) {
        object_view.depth[i] = hand_view.depth[i];
        object_view.owners[i] = 1;
      }
    object_view.roi.include(hand_view.roi.u0, hand_view.roi.v0);
    object_view.roi.include(hand_view.roi.u1 - 1, hand_view.roi.v1 - 1);
    return object_view;
  }();
  for (int i = 0; i < 30; ++i) bench.fuse(both);
  const auto hand_voxels = [&] {
    int n = 0;
    const Volume& v = bench.volume;
    for (int z = 0; z < v.side; ++z)
      for (int y = 0; y < v.side; ++y)
        for (int x = 0; x < v.side; ++x) {
          const std::int16_t s = v.tsdf[v.index(x, y, z)];
          if (s != kUnseen && s < 0 && object.distance(to_double(v.position(x, y, z))) > 0.012) ++n;
        }
    return n;
  };
  CHECK(hand_voxels() > 500);
  View alone = render(object, T, how, random);
  alone.roi = both.roi;
  for (int i = 0; i < 60; ++i) bench.fuse(alone);
  CHECK(hand_voxels() < 10);
  CHECK(surface_error(bench.volume, object).mean_m < 0.0006);
}

TEST(Integrate, WhatStandsBeforeTheObjectCarvesNothing) {
  const Sphere object(0.08);
  Bench bench(96);
  bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
  View view = render(object, looking_at(0.9, 0, 0.4), how, random);
  for (int i = 0; i < 10; ++i) bench.fuse(view);
  const std::vector<std::int16_t> before(bench.volume.tsdf.begin(), bench.volume.tsdf.end());
  for (std::size_t i = 0; i < view.depth.size(); ++i) {  // something else passes far in front, and holes
    view.depth[i] = i % 5 == 0 ? 0.0f : 0.5f;
    view.owners[i] = 7;
  }
  for (int i = 0; i < 20; ++i) bench.fuse(view);
  MEMCMP_EQUAL(before.data(), bench.volume.tsdf.data(), before.size() * 2);
}

TEST(Integrate, SamplesOutsideOfTheBoxAreCountedAndMeasured) {
  const Sphere sphere(0.12);
  Bench bench(64);
  bench.volume.reset(0.003f, 0.012f, {0, 0, 0});  // 19 cm for a ball of 24 cm
  const IntegrateStats stats = bench.fuse(render(sphere, looking_at(0.9, 0, 0.3), how, random));
  CHECK(stats.outside_pixels > stats.surface_pixels / 4);
  CHECK(stats.outside_pixels < stats.surface_pixels);
  DOUBLES_EQUAL(-0.12, stats.low.x, 0.008);
  DOUBLES_EQUAL(0.12, stats.high.x, 0.008);
}

TEST(Integrate, InvalidReadingsAndWildPosesTouchNothing) {
  const Sphere sphere(0.12);
  Bench bench(64);
  bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
  View view = render(sphere, looking_at(0.9, 0, 0.3), how, random);
  const float nan = std::nanf("");
  std::vector<float> good = view.depth;
  for (float& z : view.depth) z = nan;
  LONGS_EQUAL(0, bench.fuse(view).updated);
  view.depth.assign(good.size(), 0.0f);
  LONGS_EQUAL(0, bench.fuse(view).updated);
  view.depth = good;
  view.T_camera_object.t = {0, 0, -3};  // behind the camera
  LONGS_EQUAL(0, bench.fuse(view).updated);
  view.T_camera_object.t = {0, 0, std::nan("")};
  LONGS_EQUAL(0, bench.fuse(view).updated);
  view.T_camera_object.t = {0, 0, 0};  // around the camera
  bench.fuse(view);
  view.roi = {700, 500, 800, 600};
  LONGS_EQUAL(0, bench.fuse(view).updated);
}

TEST(Integrate, SkippingAndVectorsChangeNoBitBesideTheDenseScalarRule) {
  const Disc disc(0.1, 0.03);
  how.noise = 1;
  how.paint = [](const Vec3& p) {
    return pack_rgb(static_cast<std::uint8_t>(120 + 900 * p.x), static_cast<std::uint8_t>(100 + 900 * p.y),
                    40);
  };
  for (const char* target : supported_simd()) {
    std::mt19937 same(11);
    select_simd(target);
    Bench bench(64);
    bench.volume.reset(0.004f, 0.014f, {0.01f, 0, 0});
    DenseOracle oracle(bench.volume);
    IntegrateOptions options;
    options.weight_cap = 6;
    for (int i = 0; i < 14; ++i) {
      // Jumps of the pose make old surface float free, so that carving happens too.
      Pose T = looking_at(0.7 + 0.1 * (i % 3), 0.9 * i, 0.4);
      T.t.x = i % 4 == 3 ? 0.04 : 0;
      const View view = render(disc, T, how, same);
      const IntegrateStats stats = bench.fuse(view, options);
      oracle.fuse(view, bench.integrating.evidence, options);
      CHECK(stats.updated > 1000);
      if (i > 3) CHECK(stats.carved > 0);
      MEMCMP_EQUAL(oracle.tsdf.data(), bench.volume.tsdf.data(), oracle.volume.voxels() * 2);
      MEMCMP_EQUAL(oracle.weight.data(), bench.volume.weight.data(), oracle.volume.voxels());
      MEMCMP_EQUAL(oracle.observations.data(), bench.volume.observations.data(), oracle.volume.voxels());
      MEMCMP_EQUAL(oracle.color.data(), bench.volume.color.data(), oracle.volume.voxels() * 4);
      MEMCMP_EQUAL(oracle.bricks.data(), bench.volume.bricks.data(), oracle.bricks.size());
      MEMCMP_EQUAL(oracle.octants.data(), bench.volume.octants.data(), oracle.octants.size());
    }
  }
}

TEST_GROUP(VoxelColor) {
  std::mt19937 random{5};
  Rendering how;
  Sphere sphere{0.12};

  // Mean error over voxels with colour against the truth, grey levels.
  static double error(const Volume& v, const Paint& truth, int* count = nullptr) {
    double sum = 0;
    int n = 0;
    for (int z = 0; z < v.side; ++z)
      for (int y = 0; y < v.side; ++y)
        for (int x = 0; x < v.side; ++x) {
          const std::uint32_t c = v.color[v.index(x, y, z)], t = truth(to_double(v.position(x, y, z)));
          if (color_trust_of(c) == 0) continue;
          sum += (std::fabs(static_cast<double>(red_of(c)) - red_of(t)) +
                  std::fabs(static_cast<double>(green_of(c)) - green_of(t)) +
                  std::fabs(static_cast<double>(blue_of(c)) - blue_of(t))) /
                 3;
          ++n;
        }
    if (count != nullptr) *count = n;
    return sum / n;
  }

  static std::uint32_t flat(const Vec3&) { return pack_rgb(200, 120, 40); }
};

TEST(VoxelColor, RedStaysRedAndBlueStaysBlue) {
  how.paint = flat;
  Bench bench(64);
  bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
  bench.fuse(render(sphere, looking_at(0.9, 0, 0.3), how, random));
  int count = 0;
  DOUBLES_EQUAL(0, error(bench.volume, flat, &count), 1e-9);
  CHECK(count > 3000);
}

TEST(VoxelColor, SpeckleIsRefusedAndNoiseAveraged) {
  std::mt19937 speckle(9);
  how.paint = [&](const Vec3&) {
    if (speckle() % 10 == 0) return pack_rgb(0, 255, 255);  // every tenth sample is plainly wrong
    const auto noisy = [&](double mean) {
      return static_cast<std::uint8_t>(mean + 8 * gaussian(speckle) + 0.5);
    };
    return pack_rgb(noisy(200), noisy(120), noisy(60));
  };
  Bench bench(64);
  bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
  int refused = 0;
  for (int i = 0; i < 30; ++i)
    refused += bench.fuse(render(sphere, looking_at(0.9, 0, 0.3), how, random)).color_refused;
  CHECK(refused > 10000);
  CHECK(error(bench.volume, [](const Vec3&) { return pack_rgb(200, 120, 60); }) < 3.0);
}

TEST(VoxelColor, ABadFirstSampleDoesNotLockTheVoxel) {
  Bench bench(64);
  bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
  how.paint = [](const Vec3&) { return pack_rgb(10, 240, 250); };
  bench.fuse(render(sphere, looking_at(0.9, 0, 0.3), how, random));
  how.paint = flat;
  for (int i = 0; i < 4; ++i) bench.fuse(render(sphere, looking_at(0.9, 0, 0.3), how, random));
  CHECK(error(bench.volume, flat) < 1.0);
}

TEST(VoxelColor, ColourFromDepthEdgesAndGrazingAnglesIsRefused) {
  // The colour image is shifted by two pixels: along its outline the ball shows the wall's colour.
  how.paint = flat;
  View view = render(sphere, looking_at(0.9, 0, 0.3), how, random);
  const std::uint32_t wall = pack_rgb(0, 255, 0);
  std::vector<std::uint32_t> shifted(view.color.size(), wall);
  for (std::size_t i = 2; i < shifted.size(); ++i)
    if (alpha_of(view.color[i - 2]) != 0) shifted[i] = view.color[i - 2];
  view.color = shifted;
  Bench bench(64);
  bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
  bench.fuse(view);
  int green = 0, all = 0;
  for (std::size_t i = 0; i < bench.volume.voxels(); ++i) {
    if (color_trust_of(bench.volume.color[i]) == 0) continue;
    ++all;
    green += green_of(bench.volume.color[i]) == 255 ? 1 : 0;
  }
  CHECK(all > 2000);
  LONGS_EQUAL(0, green);
}

TEST(VoxelColor, MeansOfBytesAreNotBiasedByRounding) {
  // Two values in turn have their mean between two bytes; a mean that is cut off walks down.
  Bench bench(64);
  bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
  for (int i = 0; i < 200; ++i) {
    const std::uint8_t level = i % 2 == 0 ? 100 : 101;
    how.paint = [level](const Vec3&) { return pack_rgb(level, level, level); };
    bench.fuse(render(sphere, looking_at(0.9, 0, 0.3), how, random));
  }
  CHECK(error(bench.volume, [](const Vec3&) { return pack_rgb(100, 100, 100); }) <= 1.0);
}
