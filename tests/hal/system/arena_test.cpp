#include "hal/system/arena.hpp"

#include <CppUTest/TestHarness.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "hal/error.hpp"
#include "hal/system/prefault.hpp"
#include "hal/system/rusage.hpp"
#include "tests/sanitized.hpp"

using namespace st;

namespace {

std::size_t resident_pages(const Arena& arena) {
  std::vector<unsigned char> present(arena.bytes() / 4096);
  LONGS_EQUAL(0, mincore(arena.data(), arena.bytes(), present.data()));
  std::size_t count = 0;
  for (unsigned char p : present) count += p & 1U;
  return count;
}

// Runs `body` in a child, so that a limit it sets dies with it; true when it returned true.
template <typename Body>
bool in_child(Body body) {
  const pid_t child = fork();
  if (child == 0) _exit(body() ? 0 : 1);
  int status = 1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

TEST_GROUP(Arena){};

TEST(Arena, IsZeroedAlignedAndWhollyResident) {
  const Arena arena(5u << 20);
  CHECK(arena.bytes() >= (5u << 20));
  UNSIGNED_LONGS_EQUAL(0, reinterpret_cast<std::uintptr_t>(arena.data()) % (2u << 20));
  UNSIGNED_LONGS_EQUAL(arena.bytes() / 4096, resident_pages(arena));
  const auto* bytes = static_cast<const unsigned char*>(arena.data());
  for (std::size_t i = 0; i < arena.bytes(); i += 511) UNSIGNED_LONGS_EQUAL(0, bytes[i]);
}

TEST(Arena, WritingToItTakesNoPageFault) {
  const Arena arena(8u << 20);
  const ThreadUsage before = thread_usage();
  std::memset(arena.data(), 1, arena.bytes());
  if (!kSanitized) LONGS_EQUAL(0, (thread_usage() - before).faults());
}

TEST(Arena, BumpHandsOutItsMemory) {
  const Arena arena(1u << 20);
  Bump bump = arena.bump();
  const auto taken = bump.take<float>(1000);
  UNSIGNED_LONGS_EQUAL(1000, taken.size());
  POINTERS_EQUAL(arena.data(), taken.data());
}

TEST(Arena, ARefusedLockIsAWarningThatSaysWhatToDo) {
  if (kSanitized) return;
  CHECK(in_child([] {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_MEMLOCK, &none);
    // Root may lock whatever the limit says.
    if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) return false;
    const Arena arena(1u << 20);
    return !arena.lock().ok && arena.lock().text().find("startrack-limits.conf") != std::string::npos &&
           resident_pages(arena) == arena.bytes() / 4096;
  }));
}

TEST(Arena, MemoryThatIsNotThereIsBadInputWithAReason) {
  try {
    const Arena arena(std::size_t{1} << 46);
    FAIL("64 TiB were mapped");
  } catch (const Failure& failure) {
    CHECK(failure.code() == ExitCode::kBadInput);
    CHECK(std::strstr(failure.what(), "--volume") != nullptr);
  }
}

TEST_GROUP(Prefault){};

TEST(Prefault, PopulatedMemoryKeepsItsContents) {
  constexpr std::size_t kBytes = 16 * 4096;
  void* p = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  static_cast<char*>(p)[5000] = 42;
  populate_writable(p, kBytes);
  LONGS_EQUAL(42, static_cast<char*>(p)[5000]);
  const ThreadUsage before = thread_usage();
  std::memset(p, 7, kBytes);
  if (!kSanitized) LONGS_EQUAL(0, (thread_usage() - before).faults());
  munmap(p, kBytes);
}

TEST(Prefault, TheProgramsOwnDataCanBeWrittenWithoutAFault) {
  static char untouched[64 * 4096];
  CHECK(prefault_image().ok);
  const ThreadUsage before = thread_usage();
  for (std::size_t i = 0; i < sizeof untouched; i += 4096) static_cast<volatile char*>(untouched)[i] = 1;
  if (!kSanitized) LONGS_EQUAL(0, (thread_usage() - before).faults());
}

TEST_GROUP(Rusage){};

TEST(Rusage, CountsTheFaultsOfFreshMemory) {
  constexpr std::size_t kPages = 64;
  void* p = mmap(nullptr, kPages * 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  madvise(p, kPages * 4096, MADV_NOHUGEPAGE);
  const ThreadUsage before = thread_usage();
  for (std::size_t i = 0; i < kPages; ++i) static_cast<volatile char*>(p)[i * 4096] = 1;
  CHECK((thread_usage() - before).minor_faults >= static_cast<std::int64_t>(kPages));
  munmap(p, kPages * 4096);
}

TEST(Rusage, PeakMemoryRisesWithWhatIsTouched) {
  const std::uint64_t before = peak_rss_bytes();
  CHECK(before > 0);
  const Arena arena(before + (32u << 20));
  CHECK(peak_rss_bytes() >= before + (32u << 20));
}
