#include "algo/depth/convert_kernel.hpp"

#include <CppUTest/TestHarness.h>

#include <cstring>
#include <random>
#include <vector>

#include "algo/core/simd.hpp"

using namespace st;

namespace {

PixelClass expected(int q, int b, int t) {
  if (q == 0) return PixelClass::kInvalid;
  if (b == 0) return PixelClass::kNoBackground;
  if (q > b + t) return PixelClass::kNearer;
  return q + t < b ? PixelClass::kFarther : PixelClass::kSame;
}

struct Pixels {
  std::vector<std::uint16_t> q, b, t;
  explicit Pixels(std::size_t count, unsigned seed) : q(count), b(count), t(count) {
    // Half of the values close together or at the ends of the range, where saturation and equality happen.
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < count; ++i) {
      const auto pick = [&random](std::uint16_t near_to) {
        switch (random() % 6) {
          case 0:
            return std::uint16_t{0};
          case 1:
            return std::uint16_t{65535};
          case 2:
            return static_cast<std::uint16_t>(near_to + random() % 9 - 4);
          default:
            return static_cast<std::uint16_t>(random());
        }
      };
      b[i] = pick(30000);
      q[i] = pick(b[i]);
      t[i] = random() % 2 == 0 ? static_cast<std::uint16_t>(random() % 5) : pick(65530);
    }
  }
};

}  // namespace

TEST_GROUP(ConvertKernel){void teardown() override{select_simd(nullptr);
}
}
;

TEST(ConvertKernel, EveryTargetAgreesWithTheScalarRuleOnEveryLength) {
  for (const char* name : supported_simd()) {
    CHECK(select_simd(name) == SimdChoice::kDone);
    for (std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{31},
                              std::size_t{33}, std::size_t{65}, std::size_t{640 * 480 + 5}}) {
      const Pixels p(count, static_cast<unsigned>(count) + 1);
      std::vector<std::uint8_t> out(count + 1, 0xee);
      classify_against_background(p.q.data(), p.b.data(), p.t.data(), count, out.data());
      for (std::size_t i = 0; i < count; ++i)
        UNSIGNED_LONGS_EQUAL(static_cast<unsigned>(expected(p.q[i], p.b[i], p.t[i])), out[i]);
      UNSIGNED_LONGS_EQUAL(0xee, out[count]);
    }
  }
}

TEST(ConvertKernel, UnalignedImagesGiveTheSameBytes) {
  const Pixels p(1000, 3);
  std::vector<std::uint8_t> whole(1000), shifted(1000);
  classify_against_background(p.q.data(), p.b.data(), p.t.data(), 1000, whole.data());
  classify_against_background(p.q.data() + 3, p.b.data() + 3, p.t.data() + 3, 997, shifted.data() + 3);
  MEMCMP_EQUAL(whole.data() + 3, shifted.data() + 3, 997);
}
