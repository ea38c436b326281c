#include "firmware_like/sealed_section.hpp"

#include <CppUTest/TestHarness.h>
#include <pthread.h>
#include <sys/mman.h>

#include <cstdlib>
#include <cstring>

using namespace st;

namespace {

void comm(char (&name)[16]) { pthread_getname_np(pthread_self(), name, sizeof name); }

}  // namespace

TEST_GROUP(SealedSection){};

TEST(SealedSection, TheThreadBearsTheLoopsNameOnlyInside) {
  char before[16], inside[16], after[16];
  comm(before);
  {
    const SealedSection sealed;
    comm(inside);
  }
  comm(after);
  STRCMP_EQUAL("st-loop", inside);
  STRCMP_EQUAL(before, after);
}

TEST(SealedSection, CountsHeapCallsInsideAndKeepsThemAfterTheEnd) {
  SealedSection sealed;
  UNSIGNED_LONGS_EQUAL(0, sealed.heap_calls());
  void* p = std::malloc(64);
  asm volatile("" : : "g"(p) : "memory");
  std::free(p);
  sealed.end();
  void* q = std::malloc(64);
  asm volatile("" : : "g"(q) : "memory");
  std::free(q);
  UNSIGNED_LONGS_EQUAL(2, sealed.heap_calls());
}

TEST(SealedSection, CountsPageFaultsInside) {
  constexpr std::size_t kPages = 32;
  void* p = mmap(nullptr, kPages * 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  madvise(p, kPages * 4096, MADV_NOHUGEPAGE);
  SealedSection sealed;
  for (std::size_t i = 0; i < kPages; ++i) static_cast<volatile char*>(p)[i * 4096] = 1;
  sealed.end();
  CHECK(sealed.usage().minor_faults >= static_cast<std::int64_t>(kPages));
  munmap(p, kPages * 4096);
}
