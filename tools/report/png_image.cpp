#include "tools/report/png_image.hpp"

#include <png.h>

#include "hal/error.hpp"

namespace st {

std::string encode_png(const RgbaImage& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGBA;
  png_alloc_size_t bytes = 0;
  std::string out;
  if (png_image_write_to_memory(&header, nullptr, &bytes, 0, image.pixels.data(), 0, nullptr) != 0) {
    out.resize(bytes);
    if (png_image_write_to_memory(&header, out.data(), &bytes, 0, image.pixels.data(), 0, nullptr) != 0) {
      out.resize(bytes);
      return out;
    }
  }
  throw Failure(ExitCode::kBadInput, std::string("a picture could not be written as PNG: ") + header.message);
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

}  // namespace st
