// The two sweeps over whole volumes that 3-D SIFT is made of, as vector kernels.
#pragma once

#include <cstddef>

namespace st {

inline constexpr int kMostTaps = 12;  // on each side of the middle

// out[i] = taps[0] rows[0][i] + sum over k of taps[k] (rows[-k][i] + rows[k][i]), k = 1 ... radius.
// rows: the middle one of 2 radius + 1 pointers, each to `count` values.
void blur_row(const float* const* rows, const float* taps, int radius, std::size_t count, float* out);

// The largest |b[i] - a[i]|.
float largest_difference(const float* a, const float* b, std::size_t count);

}  // namespace st
