// The tester tested: a guard that catches nothing would let every other zero-allocation test pass.
#include "hal/system/heap_guard.hpp"

#include <CppUTest/TestHarness.h>

#include <atomic>
#include <cstdlib>
#include <thread>
#include <vector>

#include "tests/sanitized.hpp"

using namespace st;

namespace {

// Keeps the compiler from leaving out an allocation whose result nobody uses.
template <typename T>
void keep(T* p) {
  asm volatile("" : : "g"(p) : "memory");
}

}  // namespace

TEST_GROUP(HeapGuard){void teardown() override{disarm_heap_guard();
}
}
;

TEST(HeapGuard, CatchesMallocAndFree) {
  arm_heap_guard();
  void* p = std::malloc(100);
  keep(p);
  std::free(p);
  disarm_heap_guard();
  UNSIGNED_LONGS_EQUAL(2, heap_calls());
}

TEST(HeapGuard, CatchesAVectorThatGrows) {
  std::vector<int> numbers;
  arm_heap_guard();
  numbers.push_back(1);
  keep(numbers.data());
  disarm_heap_guard();
  CHECK(heap_calls() >= 1);
}

TEST(HeapGuard, CatchesTheOtherWaysToAllocate) {
  arm_heap_guard();
  void* zeroed = std::calloc(3, 5);
  void* grown = std::realloc(zeroed, 4000);
  keep(grown);
  void* aligned = std::aligned_alloc(64, 128);
  keep(aligned);
  void* posix = nullptr;
  LONGS_EQUAL(0, posix_memalign(&posix, 64, 128));
  keep(posix);
  int* object = new int(3);
  keep(object);
  const std::uint64_t taken = heap_calls();
  std::free(grown);
  std::free(aligned);
  std::free(posix);
  delete object;
  disarm_heap_guard();
  if (kSanitized) {
    CHECK(taken >= 3);  // ThreadSanitizer's hooks do not see the aligned ones
  } else {
    UNSIGNED_LONGS_EQUAL(5, taken);
    UNSIGNED_LONGS_EQUAL(9, heap_calls());
  }
}

TEST(HeapGuard, CountsNothingWhileDisarmed) {
  arm_heap_guard();
  disarm_heap_guard();
  void* p = std::malloc(10);
  keep(p);
  std::free(p);
  UNSIGNED_LONGS_EQUAL(0, heap_calls());
}

TEST(HeapGuard, OtherThreadsAreNotCounted) {
  std::atomic<int> step{0};
  std::thread other([&step] {
    while (step.load() != 1) std::this_thread::yield();
    void* p = std::malloc(100);
    keep(p);
    std::free(p);
    step.store(2);
    while (step.load() != 3) std::this_thread::yield();
  });
  arm_heap_guard();
  step.store(1);
  while (step.load() != 2) std::this_thread::yield();
  disarm_heap_guard();
  step.store(3);
  other.join();
  UNSIGNED_LONGS_EQUAL(0, heap_calls());
}

TEST(HeapGuard, MemoryFromEveryCallIsUsable) {
  char* zeroed = static_cast<char*>(std::calloc(100, 1));
  for (int i = 0; i < 100; ++i) LONGS_EQUAL(0, zeroed[i]);
  zeroed[99] = 7;
  char* grown = static_cast<char*>(std::realloc(zeroed, 100000));
  LONGS_EQUAL(7, grown[99]);
  std::free(grown);
  void* aligned = std::aligned_alloc(4096, 8192);
  UNSIGNED_LONGS_EQUAL(0, reinterpret_cast<std::uintptr_t>(aligned) % 4096);
  std::free(aligned);
}
