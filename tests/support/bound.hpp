// Memory for one bind(), which tells whether both of its runs took the same.
#pragma once

#include "firmware_like/heap_memory.hpp"

namespace st::test {

class BoundMemory {
 public:
  template <typename Bind>
  explicit BoundMemory(Bind bind)
      : memory_([&](Bump& bump) {
          bind(bump);
          overflowed_ = bump.overflowed() || (!bump.measuring() && bump.used() != measured_);
          measured_ = bump.used();
        }) {}
  bool overflowed() const { return overflowed_; }

 private:
  std::size_t measured_ = 0;
  bool overflowed_ = false;
  HeapMemory memory_;
};

}  // namespace st::test
