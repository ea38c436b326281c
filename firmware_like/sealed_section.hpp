// The stretch of the compute thread's life in which it must not touch the heap or take a page fault: from the
// last preparation until the last frame. While it lasts the thread is named `st-loop`, so that a counter
// outside the process knows the same stretch.
#pragma once

#include <cstdint>

#include "hal/system/rusage.hpp"

namespace st {

class SealedSection {
 public:
  // On the compute thread: makes its stack and the program's code present, then arms the heap guard.
  SealedSection();
  ~SealedSection();  // ends it, where end() was not called
  SealedSection(const SealedSection&) = delete;
  SealedSection& operator=(const SealedSection&) = delete;

  void end();

  // So far, or until end(). No heap call of their own.
  std::uint64_t heap_calls() const;
  ThreadUsage usage() const;

 private:
  bool open_ = true;
  char name_before_[16] = "";
  std::uint64_t heap_calls_ = 0;
  ThreadUsage begin_, total_;
};

}  // namespace st
