// Memory from the heap for what takes it by bind(): measured first, then taken, as the memory plan does it.
// Before and after the loop only.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/core/bump.hpp"

namespace st {

class HeapMemory {
 public:
  template <typename Bind>
  explicit HeapMemory(const Bind& bind) {
    Bump measure;
    bind(measure);
    bytes_.resize(measure.used() + Bump::kAlign);
    const auto at = reinterpret_cast<std::uintptr_t>(bytes_.data());
    Bump take(bytes_.data() + (Bump::kAlign - at % Bump::kAlign) % Bump::kAlign, measure.used());
    bind(take);
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace st
