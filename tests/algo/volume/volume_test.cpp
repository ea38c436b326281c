#include "algo/volume/volume.hpp"

#include "tests/algo/volume/analytic_view.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

// Writes the exact distance to a ball into all voxels within the band.
void fill(Volume& v, const Solid& solid) {
  for (int z = 0; z < v.side; ++z)
    for (int y = 0; y < v.side; ++y)
      for (int x = 0; x < v.side; ++x) {
        const double t = solid.distance(to_double(v.position(x, y, z))) / static_cast<double>(v.truncation_m);
        if (std::fabs(t) >= 1) continue;
        const std::size_t i = v.index(x, y, z);
        v.tsdf[i] = static_cast<std::int16_t>(std::lround(t * 32767));
        v.weight[i] = 20;
        v.observations[i] = 10;
        v.color[i] = pack_rgb(static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                              static_cast<std::uint8_t>(z), 0xF2);
        std::uint8_t& flags = v.bricks[v.brick_index(x / 8, y / 8, z / 8)];
        flags = static_cast<std::uint8_t>(flags | kBrickTouched | (t < 0 ? kBrickSolid : 0));
      }
}

bool is_empty(const Volume& v) {
  for (std::size_t i = 0; i < v.voxels(); ++i)
    if (v.tsdf[i] != kUnseen || v.weight[i] != 0 || v.observations[i] != 0 || v.color[i] != 0) return false;
  for (std::uint8_t b : v.bricks)
    if (b != 0) return false;
  return true;
}

}  // namespace

TEST_GROUP(Volume) {
  Bench bench{64, 64, 64};
  Volume& v = bench.volume;
  Sphere ball{0.09};

  void setup() override {
    for (std::size_t i = 0; i < bench.memory.size(); ++i)  // memory as it was left by somebody else
      if (&bench.memory[i] < reinterpret_cast<std::uint8_t*>(v.bricks.data())) bench.memory[i] = 0x5A;
    v.reset(0.004f, 0.016f, {0.01f, 0.02f, 0.03f});
  }
};

TEST(Volume, EightBytesAVoxel) {
  Bump measure;
  Volume big;
  big.bind(measure, 128);
  CHECK(measure.used() < 128u * 128 * 128 * 8 + 16384);
}

TEST(Volume, ResetLeavesNothingBehindOnUsedMemory) {
  CHECK(is_empty(v));
  fill(v, ball);
  CHECK(!is_empty(v));
  v.reset(0.005f, 0.02f, {0, 0, 0});
  CHECK(is_empty(v));
}

TEST(Volume, TheBoxIsCentredWhereItWasAsked) {
  DOUBLES_EQUAL(0.03, v.centre().z, 1e-6);
  DOUBLES_EQUAL(0.01, 0.5 * (v.position(0, 0, 0).x + v.position(63, 63, 63).x), 1e-6);
}

TEST(Volume, SamplesAgreeWithTheAnalyticDistanceAndGradient) {
  fill(v, ball);
  int checked = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 n = normalized(Vec3{std::sin(i * 1.7), std::cos(i * 2.3), std::sin(i * 0.9 + 1)});
    const Vec3 p = n * (0.09 + 0.006 * std::sin(i * 3.1));
    const SdfSample s = sample(v, to_float(p));
    if (!s.valid) continue;
    ++checked;
    DOUBLES_EQUAL(ball.distance(p), s.sdf_m, 0.00012);
    CHECK(norm(to_double(s.gradient) - n) < 0.05);
  }
  CHECK(checked > 190);
}

TEST(Volume, SamplesOutsideOrBesideUnseenVoxelsAreInvalid) {
  fill(v, ball);
  CHECK(!sample(v, {0, 0, 0}).valid);
  CHECK(!sample(v, {9, 0, 0}).valid);
  CHECK(!sample(v, {std::nanf(""), 0, 0}).valid);
  CHECK(!sample_color(v, {0, 0, 0}).valid);
  const Vec3f p = v.position(40, 30, 20);
  v.color[v.index(40, 30, 20)] = pack_rgb(40, 30, 20, 0xF2);
  const ColorSample c = sample_color(v, p + Vec3f{1e-5f, 1e-5f, 1e-5f});
  CHECK(c.valid);
  DOUBLES_EQUAL(40, c.r, 0.1);
  DOUBLES_EQUAL(20, c.b, 0.1);
}

TEST(Volume, RecentringKeepsEveryVoxelThatStaysInItsPlaceInTheObjectFrame) {
  for (const BrickShift shift :
       {BrickShift{1, -2, 0}, BrickShift{-3, 0, 2}, BrickShift{0, 0, 0}, BrickShift{9, 0, 0}}) {
    v.reset(0.004f, 0.016f, {0.01f, 0.02f, 0.03f});
    fill(v, ball);
    Bench other(64, 64, 64);
    Volume& before = other.volume;
    before.reset(0.004f, 0.016f, {0.01f, 0.02f, 0.03f});
    fill(before, ball);
    recentre(v, shift);
    int kept = 0;
    for (int z = 0; z < 64; ++z)
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          const int ox = x - 8 * shift.x, oy = y - 8 * shift.y, oz = z - 8 * shift.z;
          const bool inside = ox >= 0 && oy >= 0 && oz >= 0 && ox < 64 && oy < 64 && oz < 64;
          const std::size_t i = v.index(x, y, z);
          if (!inside) {
            LONGS_EQUAL(kUnseen, v.tsdf[i]);
            UNSIGNED_LONGS_EQUAL(0, v.color[i]);
            continue;
          }
          const std::size_t o = before.index(ox, oy, oz);
          LONGS_EQUAL(before.tsdf[o], v.tsdf[i]);
          UNSIGNED_LONGS_EQUAL(before.color[o], v.color[i]);
          UNSIGNED_LONGS_EQUAL(before.weight[o], v.weight[i]);
          UNSIGNED_LONGS_EQUAL(before.observations[o], v.observations[i]);
          CHECK(norm(to_double(before.position(ox, oy, oz) - v.position(x, y, z))) < 1e-6);
          kept += before.tsdf[o] != kUnseen ? 1 : 0;
        }
    CHECK(kept > 1000 || shift.x == 9);
    v.reset(0.004f, 0.016f, {0, 0, 0});
    CHECK(is_empty(v));  // the flags moved with the content
  }
}

TEST(Volume, ShiftTowardsBringsTheMiddleWithinHalfABrick) {
  const Vec3f wanted{0.10f, -0.07f, 0.0f};
  recentre(v, shift_towards(v, wanted));
  const Vec3f off = v.centre() - wanted;
  for (int a = 0; a < 3; ++a) CHECK(std::fabs(off[a]) <= 0.5f * 8 * 0.004f + 1e-6f);
}

TEST(Volume, VoxelSizeLeavesRoomAndTruncationCoversTheNoise) {
  CHECK(choose_voxel_m(0.34f, 128) * 128 > 1.5f * 0.34f);
  DOUBLES_EQUAL(0.002, choose_voxel_m(0.05f, 128), 1e-7);
  DOUBLES_EQUAL(0.016, choose_truncation_m(0.004f, 0.001f), 1e-6);
  DOUBLES_EQUAL(0.027, choose_truncation_m(0.004f, 0.009f), 1e-6);
  DOUBLES_EQUAL(0.040, choose_truncation_m(0.004f, 0.050f), 1e-6);
}
