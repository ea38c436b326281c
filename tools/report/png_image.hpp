// Pictures for a page: RGB with alpha to PNG, and PNG into the page itself.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace st {

struct RgbaImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  // four bytes a pixel, row by row
};

// Throws Failure when libpng refuses.
std::string encode_png(const RgbaImage& image);

std::string base64(std::string_view bytes);

}  // namespace st
