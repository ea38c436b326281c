// A vector with its capacity in the type: no heap, refuses when full and remembers how full it ever was.
#pragma once

#include <cstddef>

namespace st {

template <typename T, std::size_t N>
class FixedVector {
 public:
  static constexpr std::size_t capacity() { return N; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == N; }
  std::size_t high_water() const { return high_water_; }
  std::size_t refused() const { return refused_; }

  // False, and counted, when there is no room.
  bool push_back(const T& value) {
    if (size_ == N) {
      ++refused_;
      return false;
    }
    items_[size_++] = value;
    if (size_ > high_water_) high_water_ = size_;
    return true;
  }
  void clear() { size_ = 0; }
  void pop_back() {
    if (size_ > 0) --size_;
  }
  // Removes item i and keeps the order of the others.
  void erase(std::size_t i) {
    for (std::size_t k = i + 1; k < size_; ++k) items_[k - 1] = items_[k];
    --size_;
  }

  T& operator[](std::size_t i) { return items_[i]; }
  const T& operator[](std::size_t i) const { return items_[i]; }
  T* begin() { return items_; }
  T* end() { return items_ + size_; }
  const T* begin() const { return items_; }
  const T* end() const { return items_ + size_; }

 private:
  T items_[N]{};
  std::size_t size_ = 0, high_water_ = 0, refused_ = 0;
};

}  // namespace st
