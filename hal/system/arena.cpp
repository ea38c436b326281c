#include "hal/system/arena.hpp"

#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "hal/error.hpp"
#include "hal/system/prefault.hpp"

namespace st {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr double kMiB = 1024.0 * 1024.0;

std::string in_mib(std::size_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f MiB", static_cast<double>(bytes) / kMiB);
  return text;
}

// Starts on a huge page, so that the kernel can use them from the first byte: maps more and gives back the
// ends.
void* map_aligned(std::size_t bytes) {
  void* all = mmap(nullptr, bytes + kHugePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (all == MAP_FAILED) return nullptr;
  const auto begin = reinterpret_cast<std::uintptr_t>(all);
  const std::uintptr_t aligned = (begin + kHugePage - 1) / kHugePage * kHugePage;
  if (aligned > begin) munmap(all, aligned - begin);
  const std::uintptr_t end = begin + bytes + kHugePage;
  if (end > aligned + bytes) munmap(reinterpret_cast<void*>(aligned + bytes), end - aligned - bytes);
  return reinterpret_cast<void*>(aligned);
}

// Bytes of the mapping that starts at `data` which stand in transparent huge pages; 0 when the kernel does
// not say.
std::size_t huge_bytes_of(const void* data) {
  std::FILE* maps = std::fopen("/proc/self/smaps", "r");
  if (maps == nullptr) return 0;
  char line[512];
  bool ours = false;
  std::size_t kib = 0;
  while (std::fgets(line, sizeof line, maps) != nullptr) {
    std::uintptr_t begin = 0, end = 0;
    if (std::sscanf(line, "%" SCNxPTR "-%" SCNxPTR " ", &begin, &end) == 2)
      ours = begin == reinterpret_cast<std::uintptr_t>(data);
    if (ours && std::sscanf(line, "AnonHugePages: %zu kB", &kib) == 1) break;
  }
  std::fclose(maps);
  return kib * 1024;
}

SetupStep lock_range(const void* data, std::size_t bytes) {
  if (mlock(data, bytes) == 0) return {true, "memory: " + in_mib(bytes) + " locked"};
  const int error = errno;
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  const std::string allowed = limit.rlim_cur == RLIM_INFINITY ? "unlimited" : in_mib(limit.rlim_cur);
  return {false,
          "memory: " + in_mib(bytes) + " not locked (" + std::strerror(error) + ", limit " + allowed +
              "), frames may come late when memory is short",
          kInstallLimits};
}

}  // namespace

Arena::Arena(std::size_t bytes) : bytes_((bytes + kHugePage - 1) / kHugePage * kHugePage) {
  data_ = map_aligned(bytes_);
  if (data_ == nullptr) {
    throw Failure(ExitCode::kBadInput, "memory: cannot map " + in_mib(bytes_) + ": " + std::strerror(errno) +
                                           "; close other programs or choose a smaller --volume");
  }
  madvise(data_, bytes_, MADV_HUGEPAGE);
  madvise(data_, bytes_, MADV_DONTFORK);
  populate_writable(data_, bytes_);
  lock_ = lock_range(data_, bytes_);
  const std::size_t huge = huge_bytes_of(data_);
  pages_ = {huge == bytes_,
            "memory: " + in_mib(bytes_) + " populated, " + in_mib(huge) + " of it in huge pages"};
  if (huge == 0) pages_.remedy = "echo madvise | sudo tee /sys/kernel/mm/transparent_hugepage/enabled";
}

Arena::~Arena() { munmap(data_, bytes_); }

}  // namespace st
