#include "hal/results/text_format.hpp"

#include <CppUTest/TestHarness.h>

#include <clocale>
#include <limits>

#include "algo/core/scalar_math.hpp"

using namespace st;

TEST_GROUP(TextFormat){static std::string fixed(double value, int decimals){std::string out;
append_fixed(out, value, decimals);
return out;
}
}
;

TEST(TextFormat, KeepsTheStampOfARecordingToTheMicrosecond) {
  STRCMP_EQUAL("1400101000.030870", fixed(1400101000.030870, 6).c_str());
  STRCMP_EQUAL("0.000000", fixed(0, 6).c_str());
}

TEST(TextFormat, WritesNoMinusZero) {
  STRCMP_EQUAL("0.000", fixed(-0.0, 3).c_str());
  STRCMP_EQUAL("0.000", fixed(-0.0004, 3).c_str());
  STRCMP_EQUAL("-0.001", fixed(-0.0006, 3).c_str());
  std::string out;
  append_scientific(out, -0.0, 2);
  STRCMP_EQUAL("0.00e+00", out.c_str());
}

TEST(TextFormat, LeavesNothingForWhatIsNotFinite) {
  STRCMP_EQUAL("", fixed(std::numeric_limits<double>::quiet_NaN(), 3).c_str());
  STRCMP_EQUAL("", fixed(std::numeric_limits<double>::infinity(), 3).c_str());
}

TEST(TextFormat, DoesNotFollowTheLocale) {
  // Whatever locales this PC has: with a German one the C library would write a comma.
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    std::setlocale(LC_ALL, name);
    STRCMP_EQUAL("1234.500", fixed(1234.5, 3).c_str());
  }
  std::setlocale(LC_ALL, "C");
}

TEST(TextFormat, AYawStaysInsideItsRangeWhenRounded) {
  std::string out;
  append_yaw(out, kPi);
  STRCMP_EQUAL("3.141592", out.c_str());
}
