#include "firmware_like/memory_plan.hpp"

#include <CppUTest/TestHarness.h>

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "hal/error.hpp"

using namespace st;

namespace {

struct Images {
  std::size_t count;
  std::span<float> depth;
  std::span<std::uint8_t> mask;
  void bind(Bump& bump) {
    depth = bump.take<float>(count);
    mask = bump.take<std::uint8_t>(count + 1);
  }
};

// Takes more when the memory is real.
struct Cheat {
  void bind(Bump& bump) { bump.take<char>(bump.measuring() ? 64 : 128); }
};

template <typename Body>
bool fails(Body body) {
  try {
    body();
    return false;
  } catch (const Failure&) {
    return true;
  }
}

}  // namespace

TEST_GROUP(MemoryPlan){};

TEST(MemoryPlan, MeasuresWhatThePartsWillTake) {
  Images a{100, {}, {}}, b{33, {}, {}};
  MemoryPlan plan;
  plan.add("images a", "algo/depth", a);
  plan.add("images b", "algo/depth", b);
  UNSIGNED_LONGS_EQUAL(448 + 128, plan.entries()[0].bytes);  // 400 and 101 bytes, each from a cache line on
  UNSIGNED_LONGS_EQUAL(plan.entries()[0].bytes + plan.entries()[1].bytes, plan.bytes());
  CHECK(a.depth.empty());
}

TEST(MemoryPlan, SealingHandsOutExactlyThePlannedMemory) {
  Images a{100, {}, {}}, b{33, {}, {}};
  MemoryPlan plan;
  plan.add("images a", "algo/depth", a);
  plan.add("images b", "algo/depth", b);
  std::vector<std::uint64_t> storage(plan.bytes() / 8 + 8);
  plan.seal(Bump(storage.data(), plan.bytes()));
  CHECK(plan.sealed());
  UNSIGNED_LONGS_EQUAL(100, a.depth.size());
  UNSIGNED_LONGS_EQUAL(34, b.mask.size());
  CHECK(static_cast<void*>(a.mask.data() + a.mask.size()) <= static_cast<void*>(b.depth.data()));
}

TEST(MemoryPlan, TooLittleMemoryIsRefused) {
  Images a{100, {}, {}};
  MemoryPlan plan;
  plan.add("images a", "algo/depth", a);
  std::vector<std::uint64_t> storage(plan.bytes() / 8);
  CHECK(fails([&] { plan.seal(Bump(storage.data(), plan.bytes() - 64)); }));
}

TEST(MemoryPlan, APartThatTakesAnotherAmountIsFound) {
  Cheat cheat;
  MemoryPlan plan;
  plan.add("cheat", "tests", cheat);
  std::vector<std::uint64_t> storage(1024);
  CHECK(fails([&] { plan.seal(Bump(storage.data(), 8192)); }));
}

TEST(MemoryPlan, NothingIsAddedAfterSealing) {
  Images a{4, {}, {}};
  MemoryPlan plan;
  std::uint64_t storage[8];
  plan.seal(Bump(storage, sizeof storage));
  CHECK(fails([&] { plan.add("late", "tests", a); }));
  CHECK(fails([&] { plan.seal(Bump(storage, sizeof storage)); }));
}

TEST(MemoryPlan, ThePrintNamesEveryPartAndTheTotal) {
  Images a{1 << 18, {}, {}};
  MemoryPlan plan;
  plan.add("images a", "algo/depth", a);
  char text[1024] = "";
  std::FILE* out = fmemopen(text, sizeof text, "w");
  plan.print(out);
  std::fclose(out);
  CHECK(std::strstr(text, "images a") != nullptr);
  CHECK(std::strstr(text, "algo/depth") != nullptr);
  CHECK(std::strstr(text, "total") != nullptr);
  CHECK(std::strstr(text, "1.250") != nullptr);
}
