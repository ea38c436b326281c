// Lets the low parts of a segment join it.
#pragma once

#include <cstdint>

#include "algo/core/image.hpp"
#include "algo/segmentation/background.hpp"

namespace st {

// Labels pixels in and around `box` that lie ahead of their background by less than its tolerance but
// clearly, and beside at least three pixels of the label: hysteresis (Canny 1986). The foot of a thing on the
// floor, or a bay in its top, does not clear the tolerance by itself. One pass down and one up; boxes over an
// eighth of the image, which need it least and would take the longest, are left alone. Returns how many
// pixels joined.
int grow_label(std::uint8_t label, const Rect& box, const Background& background,
               ImageView<const std::uint16_t> code, ImageView<std::uint8_t> labels);

}  // namespace st
