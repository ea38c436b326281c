// PNG images of TUM RGB-D recordings, decoded from memory into the caller's buffer.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "algo/core/records.hpp"

namespace st {

struct ImageVerdict {
  bool ok = false;
  int width = 0, height = 0;
  DamageReason reason = DamageReason::kForeign;
  std::string what;  // when not ok: for people, without the file's name
};

// 16-bit grey, host byte order, row-major. Any size up to 640x480 that fits `out`.
ImageVerdict decode_png_depth(std::span<const std::uint8_t> file, std::span<std::uint16_t> out);

// RGB, three bytes a pixel. Grey, palette, alpha and 16-bit images are converted.
ImageVerdict decode_png_color(std::span<const std::uint8_t> file, std::span<std::uint8_t> out);

}  // namespace st
