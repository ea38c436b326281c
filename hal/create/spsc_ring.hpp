// A ring between one writing and one reading thread: no lock, no wait, no heap. A full ring refuses and
// counts.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace st {

template <typename T, std::size_t N>
class SpscRing {
 public:
  bool push(const T& value) {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == N) {
      refused_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_[head % N] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }
  bool pop(T& value) {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    value = items_[tail % N];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }
  std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }

 private:
  T items_[N]{};
  std::atomic<std::size_t> head_{0}, tail_{0};
  std::atomic<std::uint64_t> refused_{0};
};

}  // namespace st
