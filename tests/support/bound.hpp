// Memory for one bind(): measured first, then taken, as the memory plan does it.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/core/bump.hpp"

namespace st::test {

class BoundMemory {
 public:
  template <typename Bind>
  explicit BoundMemory(Bind bind) {
    Bump measure;
    bind(measure);
    bytes_.resize(measure.used() + Bump::kAlign);
    const auto at = reinterpret_cast<std::uintptr_t>(bytes_.data());
    Bump take(bytes_.data() + (Bump::kAlign - at % Bump::kAlign) % Bump::kAlign, measure.used());
    bind(take);
    overflowed_ = take.overflowed() || take.used() != measure.used();
  }
  bool overflowed() const { return overflowed_; }
  std::size_t bytes() const { return bytes_.size(); }

 private:
  std::vector<std::uint8_t> bytes_;
  bool overflowed_ = false;
};

}  // namespace st::test
