#include "firmware_like/memory_plan.hpp"

#include <string>

#include "hal/error.hpp"

namespace st {
namespace {

std::size_t aligned(std::size_t bytes) { return (bytes + Bump::kAlign - 1) / Bump::kAlign * Bump::kAlign; }

// These are mistakes in the program, not in its input; they show on the first run of a test.
[[noreturn]] void fail(const std::string& what) {
  throw Failure(ExitCode::kBadInput,
                "memory plan: " + what + "; this is a fault of the program, please report it");
}

constexpr double kMiB = 1024.0 * 1024.0;

}  // namespace

void MemoryPlan::add_entry(Entry entry) {
  if (sealed_) fail(std::string(entry.name) + " comes after the plan was sealed");
  Bump measure;
  entry.bind(entry.part, measure);
  entry.bytes = aligned(measure.used());
  if (!entries_.push_back(entry)) fail("no room for " + std::string(entry.name));
  bytes_ += entry.bytes;
}

void MemoryPlan::seal(Bump memory) {
  if (sealed_) fail("sealed twice");
  const std::size_t start = aligned(memory.used());
  std::size_t planned = start;
  for (const Entry& entry : entries_) {
    entry.bind(entry.part, memory);
    planned += entry.bytes;
    if (memory.overflowed()) fail(std::string(entry.name) + " does not fit into the memory given");
    if (aligned(memory.used()) != planned)
      fail(std::string(entry.name) + " took another amount than planned");
  }
  sealed_ = true;
}

void MemoryPlan::print(std::FILE* out) const {
  std::fprintf(out, "memory plan (MiB):\n");
  for (const Entry& entry : entries_)
    std::fprintf(out, "  %-28s %-18s %9.3f\n", entry.name, entry.owner,
                 static_cast<double>(entry.bytes) / kMiB);
  std::fprintf(out, "  %-28s %-18s %9.3f\n", "total", "", static_cast<double>(bytes_) / kMiB);
}

}  // namespace st
