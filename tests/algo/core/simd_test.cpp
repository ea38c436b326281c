#include "algo/core/simd.hpp"

#include <CppUTest/TestHarness.h>

#include <cstring>

using namespace st;

TEST_GROUP(Simd){void teardown() override{select_simd(nullptr);
}
}
;

TEST(Simd, EverySupportedSetCanBeChosenByName) {
  const auto names = supported_simd();
  CHECK(names.size() >= 1);
  for (const char* name : names) {
    CHECK(select_simd(name) == SimdChoice::kDone);
    STRCMP_EQUAL(name, simd_name());
  }
}

TEST(Simd, TheDefaultIsTheBest) {
  const auto names = supported_simd();
  CHECK(select_simd(names[0]) == SimdChoice::kDone);
  CHECK(select_simd("") == SimdChoice::kDone);
  STRCMP_EQUAL(names[names.size() - 1], simd_name());
}

TEST(Simd, AskingWhatIsSupportedKeepsTheChoice) {
  CHECK(select_simd("SSSE3") == SimdChoice::kDone);
  CHECK(supported_simd().size() >= 1);
  STRCMP_EQUAL("SSSE3", simd_name());
}

TEST(Simd, UnknownAndUnsupportedNamesAreRefusedAndChangeNothing) {
  CHECK(select_simd("SSSE3") == SimdChoice::kDone);
  CHECK(select_simd("NEON") == SimdChoice::kUnknownName);
  const auto have = supported_simd();
  for (const char* name : all_simd()) {
    bool supported = false;
    for (const char* h : have) supported = supported || std::strcmp(h, name) == 0;
    if (!supported) CHECK(select_simd(name) == SimdChoice::kNotOnThisCpu);
  }
  STRCMP_EQUAL("SSSE3", simd_name());
}
