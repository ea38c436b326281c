// The one piece of memory that the loop computes on: mapped, populated and locked once, before the first
// frame.
#pragma once

#include <cstddef>

#include "algo/core/bump.hpp"
#include "hal/system/setup_step.hpp"

namespace st {

class Arena {
 public:
  // Maps at least `bytes`, zeroed, in huge pages where the kernel gives them, with every page present. Locks
  // this range only: MCL_FUTURE would let every later mapping of the process fail once the limit is reached.
  // Children forked later do not inherit it (a fork would otherwise make every page fault again). Throws
  // Failure when there is not that much memory.
  explicit Arena(std::size_t bytes);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  void* data() const { return data_; }
  std::size_t bytes() const { return bytes_; }
  Bump bump() const { return {data_, bytes_}; }

  const SetupStep& pages() const { return pages_; }  // how much stands in huge pages
  const SetupStep& lock() const { return lock_; }

 private:
  void* data_ = nullptr;
  std::size_t bytes_ = 0;
  SetupStep pages_, lock_;
};

}  // namespace st
