// Headers of binary PGM (P5) and PPM (P6) as fakenect-record writes them (one line), and as any other program
// may (several lines, comments).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace st {

struct PnmHeader {
  bool color = false;  // P6
  int width = 0, height = 0;
  int max_value = 0;  // above 255: two bytes a sample
  std::size_t header_bytes = 0;

  std::size_t pixel_bytes() const {
    const std::size_t samples =
        static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * (color ? 3u : 1u);
    return samples * (max_value > 255 ? 2u : 1u);
  }
};

// `file`: the whole file, or at least its header. Where the file is longer than header and pixels, white
// space before the pixels is taken for padding of the header. Nothing when it is no P5 or P6 file, or larger
// than 65535 a side.
std::optional<PnmHeader> parse_pnm_header(std::span<const std::uint8_t> file);

}  // namespace st
