#include "hal/clock.hpp"

#include <ctime>

namespace st {
namespace {

std::int64_t read_ns(clockid_t id) {
  timespec t{};
  clock_gettime(id, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

class SystemClock final : public Clock {
 public:
  std::int64_t monotonic_ns() const override { return read_ns(CLOCK_MONOTONIC); }
  std::int64_t thread_cpu_ns() const override { return read_ns(CLOCK_THREAD_CPUTIME_ID); }
};

}  // namespace

const Clock& system_clock() {
  static const SystemClock clock;
  return clock;
}

}  // namespace st
