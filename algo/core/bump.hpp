// Hands out pieces of memory that somebody else owns. A first pass over no memory measures what a second pass
// needs: the memory plan is made that way, from the same bind() functions that later take the memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace st {

class Bump {
 public:
  static constexpr std::size_t kAlign = 64;  // a cache line, and the widest vector register

  Bump() = default;  // measures only
  Bump(void* memory, std::size_t bytes) : memory_(static_cast<std::uint8_t*>(memory)), bytes_(bytes) {}

  // `count` zeroed-by-the-owner elements, aligned to kAlign. Empty while measuring, or when the memory is
  // used up.
  template <typename T>
  std::span<T> take(std::size_t count) {
    const std::size_t at = (used_ + kAlign - 1) / kAlign * kAlign;
    used_ = at + count * sizeof(T);
    if (memory_ == nullptr || used_ > bytes_) return {};
    return {reinterpret_cast<T*>(memory_ + at), count};
  }

  std::size_t used() const { return used_; }
  bool measuring() const { return memory_ == nullptr; }
  bool overflowed() const { return memory_ != nullptr && used_ > bytes_; }

 private:
  std::uint8_t* memory_ = nullptr;
  std::size_t bytes_ = 0;
  std::size_t used_ = 0;
};

}  // namespace st
