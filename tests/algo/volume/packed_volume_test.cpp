#include "algo/volume/packed_volume.hpp"

#include "tests/algo/volume/analytic_view.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

void fuse_ball(Bench& bench) {
  bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
  std::mt19937 random(3);
  Rendering how;
  how.paint = [](const Vec3& p) { return pack_rgb(static_cast<std::uint8_t>(128 + 300 * p.x), 90, 60); };
  for (int i = 0; i < 4; ++i) bench.fuse(render(Sphere(0.12), looking_at(1.0, 1.6 * i, 0.5), how, random));
}

}  // namespace

TEST_GROUP(PackedVolume){};

TEST(PackedVolume, WhatIsNearTheSurfaceComesBack) {
  Bench from(128), to(128);
  fuse_ball(from);
  std::vector<PackedBrick> bricks(count_packed(from.volume));
  const PackedVolume packed = pack(from.volume, bricks);
  LONGS_EQUAL(bricks.size(), packed.bricks.size());
  CHECK_TRUE(bricks.size() < 16 * 16 * 16 / 4);
  to.volume.reset(0.1f, 1, {});
  CHECK_TRUE(unpack(packed, to.volume));
  for (std::size_t i = 0; i < from.volume.voxels(); ++i) {
    const std::int16_t tsdf = from.volume.tsdf[i];
    if (tsdf == kUnseen || tsdf >= 32767 || tsdf <= -32767) continue;
    CHECK_TRUE(tsdf == to.volume.tsdf[i] && from.volume.weight[i] == to.volume.weight[i] &&
               from.volume.color[i] == to.volume.color[i]);
  }
}

TEST(PackedVolume, ALargerVolumeHoldsItInTheSamePlace) {
  Bench from(128), to(192);
  fuse_ball(from);
  std::vector<PackedBrick> bricks(count_packed(from.volume));
  to.volume.reset(0.1f, 1, {});
  CHECK_TRUE(unpack(pack(from.volume, bricks), to.volume));
  for (const Vec3f p : {Vec3f{0.12f, 0.01f, 0.02f}, Vec3f{0, -0.118f, 0.03f}, Vec3f{0.05f, 0.05f, 0.1f}}) {
    const SdfSample a = sample(from.volume, p), b = sample(to.volume, p);
    CHECK_EQUAL(a.valid, b.valid);
    DOUBLES_EQUAL(static_cast<double>(a.sdf_m), static_cast<double>(b.sdf_m), 1e-6);
  }
}

TEST(PackedVolume, OneThatDoesNotFitIsRefused) {
  Bench from(192), to(128);
  from.volume.reset(0.002f, 0.008f, {0, 0, 0});
  std::mt19937 random(3);
  from.fuse(render(Sphere(0.17), looking_at(1.0, 0, 0.5), {}, random));
  std::vector<PackedBrick> bricks(count_packed(from.volume));
  to.volume.reset(0.1f, 1, {});
  CHECK_FALSE(unpack(pack(from.volume, bricks), to.volume));
  for (const std::uint8_t flags : to.volume.bricks) LONGS_EQUAL(0, flags);
}
