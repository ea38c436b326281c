// The clock as a seam: tests put their own behind it.
#pragma once

#include <cstdint>

namespace st {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::int64_t monotonic_ns() const = 0;
  virtual std::int64_t thread_cpu_ns() const = 0;  // CPU time of the calling thread
};

const Clock& system_clock();

}  // namespace st
