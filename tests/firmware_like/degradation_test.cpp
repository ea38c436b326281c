// In simulated time: the ladder sees only the times it is told.
#include "firmware_like/degradation.hpp"

#include <CppUTest/TestHarness.h>

using namespace st;

namespace {

constexpr double kPeriod_s = 1.0 / 30, kPeriod_us = 1e6 / 30;
constexpr double kLate_us = 0.95 * kPeriod_us, kMiddling_us = 0.75 * kPeriod_us, kEasy_us = 0.3 * kPeriod_us;

int after(Degradation& ladder, int frames, double cost_us) {
  for (int i = 0; i < frames; ++i) ladder.next(cost_us);
  return ladder.level();
}

}  // namespace

TEST_GROUP(Degradation) { Degradation ladder{kPeriod_s}; };

TEST(Degradation, FramesInTimeGetFullWork) {
  LONGS_EQUAL(0, after(ladder, 1000, kEasy_us));
  LONGS_EQUAL(0, after(ladder, 1000, kMiddling_us));
}

TEST(Degradation, EveryLateFrameGoesOneStepDownAndNoFurtherThanTheLast) {
  LONGS_EQUAL(1, ladder.next(kLate_us));
  LONGS_EQUAL(2, ladder.next(kLate_us));
  LONGS_EQUAL(3, ladder.next(kLate_us));
  LONGS_EQUAL(3, after(ladder, 100, kLate_us));
}

TEST(Degradation, ComesBackOneStepAfterEnoughEasyFrames) {
  after(ladder, 2, kLate_us);
  LONGS_EQUAL(2, after(ladder, Degradation::kEasyFrames - 1, kEasy_us));
  LONGS_EQUAL(1, ladder.next(kEasy_us));
  LONGS_EQUAL(0, after(ladder, Degradation::kEasyFrames, kEasy_us));
}

TEST(Degradation, FramesThatLeaveNoRoomDoNotCountTowardsComingBack) {
  ladder.next(kLate_us);
  LONGS_EQUAL(1, after(ladder, 1000, kMiddling_us));
  after(ladder, Degradation::kEasyFrames - 1, kEasy_us);
  ladder.next(kMiddling_us);
  LONGS_EQUAL(1, after(ladder, Degradation::kEasyFrames - 1, kEasy_us));
}

TEST(Degradation, ARelapseMakesTheNextReturnWaitTwiceAsLong) {
  ladder.next(kLate_us);
  after(ladder, Degradation::kEasyFrames, kEasy_us);
  LONGS_EQUAL(0, ladder.level());
  LONGS_EQUAL(1, ladder.next(kLate_us));
  LONGS_EQUAL(1, after(ladder, 2 * Degradation::kEasyFrames - 1, kEasy_us));
  LONGS_EQUAL(0, ladder.next(kEasy_us));
}

TEST(Degradation, AReturnThatHoldsForgetsTheRelapse) {
  ladder.next(kLate_us);
  after(ladder, Degradation::kEasyFrames, kEasy_us);
  ladder.next(kLate_us);
  after(ladder, 10 * Degradation::kEasyFrames, kEasy_us);
  LONGS_EQUAL(1, ladder.next(kLate_us));
  LONGS_EQUAL(0, after(ladder, Degradation::kEasyFrames, kEasy_us));
}

TEST(Degradation, AMachineThatIsAlwaysTooSlowForFullWorkSettlesInsteadOfFlapping) {
  // Level 0 costs too much, level 1 is easy.
  int at_full_work = 0;
  for (int frame = 0; frame < 30 * 60; ++frame) {
    const bool full = ladder.level() == 0;
    at_full_work += full ? 1 : 0;
    ladder.next(full ? kLate_us : kEasy_us);
  }
  CHECK(at_full_work < 10);
}

TEST(Degradation, TheLadderOnlyTakesWorkAway) {
  for (int level = 1; level < kLevels; ++level) {
    const LadderStep &above = ladder_step(level - 1), &step = ladder_step(level);
    LONGS_EQUAL(level, step.level);
    CHECK(!step.color_term || above.color_term);
    CHECK(!step.integrate || above.integrate);
    CHECK(step.point_stride >= above.point_stride);
  }
  LONGS_EQUAL(0, ladder_step(-1).level);
  LONGS_EQUAL(kLevels - 1, ladder_step(99).level);
}
