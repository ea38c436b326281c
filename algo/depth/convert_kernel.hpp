// Every pixel of a depth frame beside the background, full frame at the width of the machine's vectors.
#pragma once

#include <cstddef>
#include <cstdint>

namespace st {

// Written as one byte a pixel.
enum class PixelClass : std::uint8_t {
  kSame = 0,          // within the threshold of the background
  kNearer = 1,        // in front of it: q > b + t
  kFarther = 2,       // behind it: q + t < b
  kInvalid = 3,       // no reading now
  kNoBackground = 4,  // a reading where the background has none
};

// `q`: inverse-depth codes (larger is nearer), 0 where there is no reading. `background`: mean code, 0 where
// none is known. `threshold`: codes of difference that noise explains, a pixel each. All arrays `count` long,
// any alignment; `out` may not overlap them. Integer arithmetic: the same bytes on every target.
void classify_against_background(const std::uint16_t* q, const std::uint16_t* background,
                                 const std::uint16_t* threshold, std::size_t count, std::uint8_t* out);

}  // namespace st
