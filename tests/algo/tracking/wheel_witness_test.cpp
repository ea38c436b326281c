#include "algo/tracking/wheel_witness.hpp"

#include <CppUTest/TestHarness.h>

using namespace st;

TEST_GROUP(WheelWitness) {
  WheelWitness witness;
  // Frames until the wheels are not asked any more; -1: they always are.
  int frames_until_doubt(double told_rad, double more_rad, int frames = 200) {
    for (int i = 0; i < frames; ++i) {
      if (!witness.trusted()) return i;
      witness.seen(told_rad, more_rad);
    }
    return -1;
  }
};

TEST(WheelWitness, NoiseAndAFewPercentAreNoDoubt) {
  for (int i = 0; i < 300; ++i) {
    CHECK(witness.trusted());
    witness.seen(0.04, i % 2 == 0 ? 0.012 : -0.010);
  }
  LONGS_EQUAL(-1, frames_until_doubt(0.04, 0.003));
}

TEST(WheelWitness, ARobotThatIsHeldFastIsNoticedAtOnce) {
  const int frames = frames_until_doubt(0.04, -0.03);
  CHECK(frames > 0 && frames < 5);
}

TEST(WheelWitness, AsksAgainAfterAWhile) {
  frames_until_doubt(0, 0.05);
  int asked_again = 0;
  for (int i = 1; asked_again == 0 && i < 100; ++i)
    if (witness.trusted()) asked_again = i;
  CHECK(asked_again > 30 && asked_again < 60);
}
