#include "algo/depth/depth_tables.hpp"

#include <CppUTest/TestHarness.h>

#include <vector>

#include "algo/depth/noise_model.hpp"
#include "algo/depth/preprocess.hpp"
#include "tests/support/bound.hpp"
#include "tests/support/test_scene.hpp"

using namespace st;

namespace {

struct Bound {
  DepthTables tables;
  test::BoundMemory memory;
  explicit Bound(const Calibration& c) : memory([&](Bump& b) { tables.bind(b, c); }) { tables.configure(c); }
};

Calibration scaled(int width, int height) {
  Calibration c = test::kinect_calibration(width, height);
  c.encoding = DepthEncoding::kScaled16;
  return c;
}

}  // namespace

TEST_GROUP(DepthTables){};

TEST(DepthTables, RawStepIsEightCodesAndMetresAreExact) {
  const Bound b(Calibration{});
  CHECK_FALSE(b.memory.overflowed());
  for (std::size_t raw = 500; raw < 1000; ++raw) {
    const int q = b.tables.code_of_stored()[raw];
    LONGS_EQUAL(8, q - b.tables.code_of_stored()[raw + 1]);
    const double z = 345.4894 / (1089.408 - static_cast<double>(raw));
    DOUBLES_EQUAL(z, static_cast<double>(b.tables.z_of_stored()[raw]), z * 1e-6);
    // The codes' rounding is an offset that the table takes out again: no bias of 0.02 % is left.
    DOUBLES_EQUAL(z, static_cast<double>(b.tables.z_of_code()[static_cast<std::size_t>(q)]), z * 1e-6);
  }
}

TEST(DepthTables, OtherKinectsFactorsKeepTheStep) {
  Calibration c;
  c.raw_a = 338.2;
  c.raw_b = 1086.1;
  const Bound b(c);
  LONGS_EQUAL(8, b.tables.code_of_stored()[800] - b.tables.code_of_stored()[801]);
  const std::size_t q = b.tables.code_of_stored()[800];
  DOUBLES_EQUAL(338.2 / (1086.1 - 800), static_cast<double>(b.tables.z_of_code()[q]), 1e-6);
}

TEST(DepthTables, NoReadingAndOutOfRangeAreZero) {
  const Bound raw{Calibration{}};
  for (std::size_t bad :
       {std::size_t{2047}, std::size_t{1060}, std::size_t{1500}, std::size_t{0}, std::size_t{50}}) {
    LONGS_EQUAL(0, raw.tables.code_of_stored()[bad]);
    DOUBLES_EQUAL(0, static_cast<double>(raw.tables.z_of_stored()[bad]), 0);
  }
  const Bound mm{scaled(640, 480)};
  for (std::size_t bad : {std::size_t{0}, std::size_t{65535}, std::size_t{340}, std::size_t{10001}})
    LONGS_EQUAL(0, mm.tables.code_of_stored()[bad]);
  CHECK(mm.tables.code_of_stored()[2000] > 0);
  DOUBLES_EQUAL(2.0, static_cast<double>(mm.tables.z_of_stored()[2000]), 1e-6);
}

TEST(DepthTables, PreprocessAgreesWithTheTablesAndCountsWhatIsInvalid) {
  const Calibration c = test::kinect_calibration(160, 120);
  const Bound b(c);
  std::vector<std::uint16_t> stored(160 * 120), code(stored.size());
  for (std::size_t i = 0; i < stored.size(); ++i)
    stored[i] = static_cast<std::uint16_t>(i % 2050 + (i % 7 == 0 ? 60000 : 0));
  const CleanDepth clean = preprocess(b.tables, {stored.data(), 160, 120}, {code.data(), 160, 120}, {});
  std::uint32_t invalid = 0;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const int expected = stored[i] < 2048 ? b.tables.code_of_stored()[stored[i]] : 0;
    LONGS_EQUAL(expected, code[i]);
    invalid += expected == 0 ? 1u : 0u;
  }
  UNSIGNED_LONGS_EQUAL(invalid, clean.invalid_pixels);
  POINTERS_EQUAL(stored.data(), clean.stored.data);
}

TEST(DepthTables, MetresOfAnImageAreThoseOfTheTable) {
  for (const Calibration& c : {Calibration{}, scaled(640, 480)}) {
    const Bound b(c);
    std::vector<std::uint16_t> code(kCodes);
    for (std::size_t q = 0; q < code.size(); ++q) code[q] = static_cast<std::uint16_t>(q);
    std::vector<float> z(code.size(), -1.0f);
    to_metres(b.tables, {code.data(), 64, kCodes / 64}, {z.data(), 64, kCodes / 64});
    DOUBLES_EQUAL(0, z[0], 0);
    for (std::size_t q = 1; q < code.size(); ++q)
      DOUBLES_EQUAL(b.tables.z_of_code()[q], z[q], 3e-7f * b.tables.z_of_code()[q]);
  }
}

TEST(DepthTables, FrameOfAnotherSizeIsAllInvalid) {
  const Bound b(test::kinect_calibration(160, 120));
  std::vector<std::uint16_t> stored(80 * 60, 800), code(160 * 120, 7);
  const CleanDepth clean = preprocess(b.tables, {stored.data(), 80, 60}, {code.data(), 160, 120}, {});
  UNSIGNED_LONGS_EQUAL(160 * 120, clean.invalid_pixels);
  for (std::uint16_t q : code) LONGS_EQUAL(0, q);
}

TEST(DepthTables, DistortionIsTakenOutSoThatRaysArePinhole) {
  Calibration c = scaled(320, 240);
  c.depth.k[0] = -0.26;
  const Bound b(c);
  // A source image that stores where it is: what arrives at an ideal pixel must come from its distorted
  // place.
  std::vector<std::uint16_t> stored(320 * 240), code(stored.size()), moved(stored.size());
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u)
      stored[static_cast<std::size_t>(v * 320 + u)] = static_cast<std::uint16_t>(1000 + u);
  const CleanDepth clean =
      preprocess(b.tables, {stored.data(), 320, 240}, {code.data(), 320, 240}, {moved.data(), 320, 240});
  const Normalized at = distort(
      c.depth, {static_cast<double>(b.tables.ray_x()[300]), static_cast<double>(b.tables.ray_y()[40])});
  const double from_u = at.x * c.depth.fx + c.depth.cx;
  CHECK(from_u < 299.0);  // it does move
  DOUBLES_EQUAL(from_u, clean.stored(300, 40) - 1000.0, 0.51);
}

TEST(DepthTables, NoiseFollowsThePublishedFigures) {
  const Bound b(Calibration{});
  // Khoshelham & Elberink 2012: 1.4 mm at 1 m, 5.7 at 2, 12.8 at 3; the stored step's own error comes on top.
  DOUBLES_EQUAL(0.0057, sigma_z_m(b.tables, 2.0), 0.0015);
  DOUBLES_EQUAL(0.0128, sigma_z_m(b.tables, 3.0), 0.003);
  CHECK(sigma_z_m(b.tables, 2.0, 0.3) > sigma_z_m(b.tables, 2.0, 0.9));
  DOUBLES_EQUAL(0.8 * 2.0 / 575.8, sigma_lateral_m(b.tables, 2.0), 1e-9);
  std::vector<float> weights(kCodes);
  fill_weights(b.tables, weights);
  DOUBLES_EQUAL(0, static_cast<double>(weights[0]), 0);
  CHECK(weights[2000] > weights[1000]);  // nearer weighs more
}

TEST(DepthTables, ACorrectionMovesEveryReadingByItsNodes) {
  Calibration c = test::kinect_calibration(32, 24);
  c.correction.columns = c.correction.rows = 2;
  const float corners[] = {1.0f, -1.0f, 2.0f, 0.0f};
  for (int i = 0; i < 4; ++i) c.correction.steps[i] = corners[i];
  const Bound b(c);
  CHECK_FALSE(b.memory.overflowed());
  std::vector<std::uint16_t> stored(32 * 24, 800), code(32 * 24), spare;
  stored[5] = 2047;
  stored[31] = static_cast<std::uint16_t>(b.tables.raw_last());  // the farthest reading, moved farther still
  const CleanDepth clean = preprocess(b.tables, {stored.data(), 32, 24}, {code.data(), 32, 24}, {});
  LONGS_EQUAL(2, clean.invalid_pixels);
  const int plain = b.tables.code_of_stored()[800];
  LONGS_EQUAL(plain + 8, code[0]);
  LONGS_EQUAL(0, code[5]);
  LONGS_EQUAL(plain + 16, code[23 * 32]);
  LONGS_EQUAL(plain, code[24 * 32 - 1]);
  LONGS_EQUAL(0, code[31]);  // beyond 10 m
  // Half way between all four nodes, 0.5 steps: a raw reading that is so much smaller is nearer.
  const std::size_t middle = 12 * 32 + 16;
  DOUBLES_EQUAL(plain + 4, code[middle], 1.0);
  const double u = 16, v = 12;
  DOUBLES_EQUAL(0.5, c.correction.at(u - 0.5, v - 0.5, 32, 24), 1e-6);
}
