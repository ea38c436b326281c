#include "hal/source/stamp_clock.hpp"

#include <CppUTest/TestHarness.h>

using namespace st;

TEST_GROUP(StampClock) {
  StampClock clock;
  static constexpr std::uint32_t kPeriod = 2'000'000;
};

TEST(StampClock, HostJitterNeverReachesTheDeviceTime) {
  for (int k = 0; k < 500; ++k) {
    const double jitter_s = 0.02 * ((k * 7) % 11 - 5) / 5.0;
    CHECK(
        clock.accept(100 + k * 0.05 + jitter_s, 4'000'000'000u + static_cast<std::uint32_t>(k) * 3'000'000u));
    DOUBLES_EQUAL(4e9 / 60e6 + k * 0.05, clock.device_t_s(), 1e-9);
  }
}

TEST(StampClock, OneBadCounterValueIsRefusedAndTheNextFramesAreNot) {
  CHECK(clock.accept(1.0, kPeriod));
  CHECK(!clock.accept(1.033, kPeriod + 1'500'000'000u));  // 25 s ahead
  CHECK(clock.accept(1.066, 3 * kPeriod));
  CHECK(!clock.accept(1.100, 3 * kPeriod));
  CHECK(!clock.accept(1.133, 2 * kPeriod));
  CHECK(clock.accept(1.166, 6 * kPeriod));
  DOUBLES_EQUAL(6.0 / 30.0, clock.device_t_s(), 1e-9);
}

TEST(StampClock, ACounterThatRestartedIsTakenUpAfterASecond) {
  for (std::uint32_t k = 0; k < 10; ++k) CHECK(clock.accept(10 + k / 30.0, 3'000'000'000u + k * kPeriod));
  const double before_s = clock.device_t_s();
  int refused = 0;
  for (std::uint32_t k = 0; k < 60; ++k) refused += !clock.accept(11 + k / 30.0, 5000 + k * kPeriod);
  LONGS_EQUAL(30, refused);
  DOUBLES_EQUAL(11 + 59 / 30.0 - (10 + 9 / 30.0), clock.device_t_s() - before_s, 1e-6);
}

TEST(StampClock, AnotherStreamsStampsAreOnTheSameClock) {
  CHECK(clock.accept(5.0, 100'000u));
  // Taken 10 ms before, on the other side of the wrap.
  DOUBLES_EQUAL(100'000 / 60e6 - 0.01, clock.device_time_of(4.995, 100'000u - 600'000u), 1e-9);
}
