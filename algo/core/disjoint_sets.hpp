// Disjoint sets of numbered things (union-find), on memory that the caller owns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace st {

// A root is its own parent and the smallest of its set, so that the result has one
// form.
class DisjointSets {
 public:
  explicit DisjointSets(std::span<std::uint32_t> parent) : parent_(parent) {
    for (std::size_t i = 0; i < parent_.size(); ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];  // each step halves the way: bounded by the vertices
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

 private:
  std::span<std::uint32_t> parent_;
};

}  // namespace st
