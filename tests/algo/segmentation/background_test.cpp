#include "algo/segmentation/background.hpp"

#include <CppUTest/TestHarness.h>

#include <vector>

#include "algo/segmentation/background_kernels.hpp"
#include "tests/support/bound.hpp"
#include "tests/support/test_scene.hpp"

using namespace st;

namespace {

constexpr int kWidth = 64, kHeight = 48;

struct Fixture {
  Calibration camera = test::kinect_calibration(kWidth, kHeight);
  DepthTables tables;
  Background background;
  test::BoundMemory memory;
  std::vector<std::uint16_t> code = std::vector<std::uint16_t>(kWidth * kHeight, 1000);
  std::vector<std::uint8_t> owner = std::vector<std::uint8_t>(kWidth * kHeight, 0);

  Fixture()
      : memory([&](Bump& b) {
          tables.bind(b, camera);
          background.bind(b, kWidth, kHeight);
        }) {
    tables.configure(camera);
    background.configure(tables);
  }
  ImageView<const std::uint16_t> view() const { return {code.data(), kWidth, kHeight}; }
  void learn() {
    for (int i = 0; i < 20 && !background.ready(); ++i) background.learn(view());
  }
  void update(int times = 1) {
    for (int i = 0; i < times; ++i) background.update(view(), {owner.data(), kWidth, kHeight}, {});
  }
  std::uint16_t& at(int u, int v) { return code[static_cast<std::size_t>(v * kWidth + u)]; }
  PixelClass kind(int u, int v) const { return static_cast<PixelClass>(background.classes()(u, v)); }
  int mean(int u, int v) const { return background.code8()(u, v) / Background::kUnit; }
};

}  // namespace

TEST_GROUP(Background){};

TEST(Background, ClassesFollowTheirDefinition) {
  const std::uint16_t code[6] = {1000, 0, 900, 1100, 1010, 0};
  const std::uint16_t mean[6] = {8000, 8000, 8000, 8000, 0, 0};
  const std::uint16_t tolerance[6] = {160, 160, 160, 160, 160, 160};
  std::uint8_t kind[6];
  background_kernels::classify(code, mean, tolerance, kind, 6);
  const PixelClass expected[6] = {PixelClass::kSame,   PixelClass::kHole,  PixelClass::kFarther,
                                  PixelClass::kNearer, PixelClass::kFresh, PixelClass::kHole};
  for (int i = 0; i < 6; ++i) LONGS_EQUAL(static_cast<int>(expected[i]), kind[i]);
}

TEST(Background, LearnsWithinTwentyFramesWithSomethingPassing) {
  Fixture f;
  for (int i = 0; !f.background.ready(); ++i) {
    CHECK(i < 20);
    f.at(10 + i, 5) = 1500;  // passes by
    f.at(9 + i, 5) = 1000;
    f.background.learn(f.view());
  }
  f.at(17, 5) = 1000;
  for (int u = 10; u < 20; ++u) LONGS_EQUAL(1000, f.mean(u, 5));
}

TEST(Background, WhatIsRevealedIsLearnedAtOnce) {
  Fixture f;
  f.learn();
  f.at(3, 3) = 700;
  f.update();
  CHECK(f.kind(3, 3) == PixelClass::kFarther);
  CHECK(f.background.revealed().empty());
  f.update();
  UNSIGNED_LONGS_EQUAL(1, f.background.revealed().size());
  f.update();
  CHECK(f.kind(3, 3) == PixelClass::kSame);
  f.at(3, 3) = 1000;  // and what stood there is foreground now
  f.update();
  CHECK(f.kind(3, 3) == PixelClass::kNearer);
}

TEST(Background, WhatStandsStillIsAbsorbedUnlessOwned) {
  Fixture f;
  f.learn();
  f.at(3, 3) = f.at(9, 9) = 1300;
  f.owner[9 * kWidth + 9] = 1;
  f.update(60);
  CHECK(f.kind(3, 3) == PixelClass::kNearer);
  f.update(60);
  CHECK(f.kind(3, 3) == PixelClass::kSame);
  f.update(2000);
  CHECK(f.kind(9, 9) == PixelClass::kNearer);
  LONGS_EQUAL(1000, f.mean(9, 9));
}

TEST(Background, OwnedPixelsDoNotDriftEither) {
  Fixture f;
  f.learn();
  f.at(3, 3) = f.at(9, 9) = 1015;  // within the tolerance: the foot of a thing
  f.owner[9 * kWidth + 9] = 2;
  f.update(1000);
  LONGS_EQUAL(1000, f.mean(9, 9));
  CHECK(f.mean(3, 3) >= 1012);  // slow drift of the sensor is followed
}

TEST(Background, AnEdgeThatFlickersIsNoForeground) {
  Fixture f;
  int foreground = 0;
  std::uint32_t random = 9;
  for (int i = 0; i < 400; ++i) {
    random = random * 1664525u + 1013904223u;
    f.at(5, 5) = (random >> 20) % 2 == 0 ? 1000 : 1400;
    if (!f.background.ready()) {
      f.background.learn(f.view());
      continue;
    }
    f.update();
    if (i > 100) foreground += f.kind(5, 5) == PixelClass::kNearer ? 1 : 0;
  }
  LONGS_EQUAL(0, foreground);
}

TEST(Background, HolesAreNeverForegroundAndFreshReadingsMustBeSteady) {
  Fixture f;
  f.at(7, 7) = 0;
  f.learn();
  f.at(3, 3) = 0;
  f.at(7, 7) = 1200;
  f.update(2);
  CHECK(f.kind(3, 3) == PixelClass::kHole);
  CHECK(f.kind(7, 7) == PixelClass::kFresh);
  f.update();
  CHECK(f.kind(7, 7) == PixelClass::kWeak);
  f.update(60);
  CHECK(f.kind(7, 7) == PixelClass::kSame);
}

TEST(Background, FreshFloorIsLearnedAtOnce) {
  Fixture f;
  f.at(7, 7) = 0;
  f.learn();
  f.at(7, 7) = 1003;
  Floor floor;
  floor.found = true;
  floor.codes = {0, 0, 1000};
  for (int i = 0; i < 3; ++i) f.background.update(f.view(), {}, floor);
  CHECK(f.kind(7, 7) == PixelClass::kSame);
}
