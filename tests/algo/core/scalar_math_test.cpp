#include "algo/core/scalar_math.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace st;

TEST_GROUP(ScalarMath){};

TEST(ScalarMath, SinAndCosAgreeWithTheLibrary) {
  for (int i = -20000; i <= 20000; ++i) {
    const double a = i * 0.0137;
    DOUBLES_EQUAL(std::sin(a), sin_cos(a).sin, 1e-13);
    DOUBLES_EQUAL(std::cos(a), sin_cos(a).cos, 1e-13);
  }
}

TEST(ScalarMath, ArcTangentAgreesWithTheLibraryAllRound) {
  for (int i = 0; i < 3600; ++i) {
    const double a = i * 0.1 * kPi / 180.0, y = 2.5 * std::sin(a), x = 2.5 * std::cos(a);
    DOUBLES_EQUAL(std::atan2(y, x), arc_tan2(y, x), 1e-13);
  }
  DOUBLES_EQUAL(0.0, arc_tan2(0, 0), 0.0);
  DOUBLES_EQUAL(kPi, arc_tan2(0, -1), 0.0);
}

TEST(ScalarMath, ExponentialAndLogarithmAgreeWithTheLibrary) {
  for (int i = -600; i <= 600; ++i) {
    const double x = i * 0.11;
    DOUBLES_EQUAL(1.0, exponential(x) / std::exp(x), 1e-13);
    DOUBLES_EQUAL(x, natural_log(std::exp(x)), 1e-12);
  }
}

TEST(ScalarMath, WrappedAnglesLieAboveMinusPiAndUpToPi) {
  for (int i = -100; i <= 100; ++i) {
    const double a = wrap_angle(i * 0.5 * kPi);
    CHECK(a > -kPi && a <= kPi);
  }
  DOUBLES_EQUAL(kPi, wrap_angle(-kPi), 1e-15);
}
