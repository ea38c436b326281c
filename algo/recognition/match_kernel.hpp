// The inner loop of matching, as a vector kernel.
#pragma once

#include <cstddef>
#include <cstdint>

namespace st {

// Sum over i of (a[i] - b[i])^2, exact. `count`: a multiple of 64.
std::uint32_t squared_distance(const std::uint8_t* a, const std::uint8_t* b, std::size_t count);

}  // namespace st
