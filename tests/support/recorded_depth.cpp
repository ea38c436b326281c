#include "tests/support/recorded_depth.hpp"

#include <png.h>

#include <cstdio>
#include <cstdlib>

namespace st::test {

std::string data_folder() {
  const char* folder = std::getenv("STARTRACK_DATA");
  return folder != nullptr ? folder : STARTRACK_SOURCE_DIR "/../shared/data";
}

std::vector<std::uint16_t> read_depth_png(const std::string& path, int width, int height) {
  std::vector<std::uint16_t> pixels;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return pixels;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_read_png(png, info, PNG_TRANSFORM_SWAP_ENDIAN, nullptr);
  const bool fits = static_cast<int>(png_get_image_width(png, info)) == width &&
                    static_cast<int>(png_get_image_height(png, info)) == height &&
                    png_get_bit_depth(png, info) == 16 &&
                    png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY;
  for (int v = 0; fits && v < height; ++v) {
    const auto* row = reinterpret_cast<const std::uint16_t*>(png_get_rows(png, info)[v]);
    pixels.insert(pixels.end(), row, row + width);
  }
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return pixels;
}

}  // namespace st::test
