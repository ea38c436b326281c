#include "firmware_like/latency_histogram.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

using namespace st;

TEST_GROUP(LatencyHistogram) { std::unique_ptr<LatencyHistogram> h = std::make_unique<LatencyHistogram>(); };

TEST(LatencyHistogram, IsEmptyAtFirst) {
  UNSIGNED_LONGS_EQUAL(0, h->count());
  DOUBLES_EQUAL(0, h->percentile_us(0.5), 0);
  DOUBLES_EQUAL(0, h->max_us(), 0);
}

TEST(LatencyHistogram, PercentilesAreNeverUnderstatedAndAtMostAFractionOver) {
  std::mt19937 random(5);
  std::lognormal_distribution<double> distribution(7.0, 1.5);
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i) {
    values.push_back(distribution(random));
    h->add(values.back());
  }
  std::sort(values.begin(), values.end());
  for (double share : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const double exact = values[static_cast<std::size_t>(std::ceil(share * 20000.0)) - 1];
    CHECK(h->percentile_us(share) >= exact - 0.001);
    CHECK(h->percentile_us(share) <= exact * (1.0 + 1.0 / 64) + 0.001);
  }
  DOUBLES_EQUAL(values.back(), h->max_us(), 0.001);
}

TEST(LatencyHistogram, OneSlowFrameInAThousandIsTheMaximumAndNotTheMedian) {
  for (int i = 0; i < 999; ++i) h->add(100);
  h->add(50000);
  DOUBLES_EQUAL(100, h->percentile_us(0.5), 2);
  DOUBLES_EQUAL(100, h->percentile_us(0.999), 2);
  DOUBLES_EQUAL(50000, h->percentile_us(0.9999), 0.01);
  DOUBLES_EQUAL(50000, h->max_us(), 0.01);
}

TEST(LatencyHistogram, OddValuesAreCountedAndDoNoHarm) {
  h->add(-5);
  h->add(std::numeric_limits<double>::quiet_NaN());
  h->add(std::numeric_limits<double>::infinity());
  h->add(5e9);
  UNSIGNED_LONGS_EQUAL(4, h->count());
  DOUBLES_EQUAL(0, h->percentile_us(0.5), 0);
  CHECK(h->percentile_us(1.0) >= 5e9);
}

TEST(LatencyHistogram, ShortTimesAreExactToTheNanosecond) {
  h->add(0.017);
  h->add(0.018);
  DOUBLES_EQUAL(0.017, h->percentile_us(0.5), 1e-9);
  DOUBLES_EQUAL(0.018, h->percentile_us(1.0), 1e-9);
}

TEST(LatencyHistogram, ResetForgetsEverything) {
  h->add(10);
  h->reset();
  UNSIGNED_LONGS_EQUAL(0, h->count());
  DOUBLES_EQUAL(0, h->max_us(), 0);
}
