// A small ordered ring of preallocated frames between a reader thread and the loop, with back-pressure:
// nothing is skipped, the reader waits for room. One writer, one reader.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "algo/core/calibration.hpp"
#include "algo/core/records.hpp"
#include "hal/source/semaphore.hpp"

namespace st {

struct FrameSlot {
  FrameSlot() : depth(static_cast<std::size_t>(kMaxWidth) * kMaxHeight) {}

  FrameInput frame;
  std::vector<std::uint16_t> depth;
};

class FrameRing {
 public:
  static constexpr unsigned kSlots = 5;

  FrameRing() : free_(kSlots) {}

  // Writer: the slot to fill next, once there is room; null after cancel().
  FrameSlot* acquire() {
    free_.wait();
    return cancelled_.load() ? nullptr : &slots_[acquired_++ % kSlots];
  }
  // Writer: makes the oldest unpublished slot visible to the reader. May lag behind acquire().
  void publish() {
    published_.fetch_add(1);
    filled_.post();
  }
  void finish() {
    finished_.store(true);
    filled_.post();
  }

  // Reader: the oldest published slot, held until release(). Null on timeout, or when finished() and nothing
  // is left.
  FrameSlot* front(int timeout_ms) {
    if (ended_ || !filled_.wait_for(timeout_ms) || cancelled_.load()) return nullptr;
    // Posts count published slots; the one of finish() comes last.
    if (taken_ == published_.load()) {
      ended_ = finished_.load();
      return nullptr;
    }
    return &slots_[taken_ % kSlots];
  }
  void release() {
    ++taken_;
    free_.post();
  }
  bool ended() const { return ended_; }

  // Either side: wakes both for good.
  void cancel() {
    cancelled_.store(true);
    free_.post();
    filled_.post();
  }
  bool cancelled() const { return cancelled_.load(); }

 private:
  FrameSlot slots_[kSlots];
  Semaphore free_, filled_{0};
  std::atomic<bool> cancelled_{false}, finished_{false};
  std::atomic<std::uint64_t> published_{0};
  std::uint64_t acquired_ = 0;  // writer's
  std::uint64_t taken_ = 0;     // reader's
  bool ended_ = false;          // reader's
};

}  // namespace st
