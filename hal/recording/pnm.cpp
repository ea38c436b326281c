#include "hal/recording/pnm.hpp"

namespace st {
namespace {

bool is_space(std::uint8_t c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\v' || c == '\f';
}

// A decimal number after white space and comments; -1 when there is none up to 65535. `at` stops behind its
// last digit.
int next_number(std::span<const std::uint8_t> file, std::size_t& at) {
  while (at < file.size() && (is_space(file[at]) || file[at] == '#')) {
    if (file[at] == '#')
      while (at < file.size() && file[at] != '\n') ++at;
    else
      ++at;
  }
  int value = -1;
  for (; at < file.size() && file[at] >= '0' && file[at] <= '9'; ++at) {
    value = (value < 0 ? 0 : value) * 10 + (file[at] - '0');
    if (value > 65535) return -1;
  }
  return value;
}

}  // namespace

std::optional<PnmHeader> parse_pnm_header(std::span<const std::uint8_t> file) {
  if (file.size() < 3 || file[0] != 'P' || (file[1] != '5' && file[1] != '6') || !is_space(file[2]))
    return std::nullopt;
  PnmHeader header;
  header.color = file[1] == '6';
  std::size_t at = 2;
  header.width = next_number(file, at);
  header.height = next_number(file, at);
  header.max_value = next_number(file, at);
  if (header.width <= 0 || header.height <= 0 || header.max_value <= 0) return std::nullopt;
  if (at >= file.size() || !is_space(file[at])) return std::nullopt;
  ++at;
  const std::size_t pixels = header.pixel_bytes();
  while (file.size() > at + pixels && is_space(file[at])) ++at;
  header.header_bytes = at;
  return header;
}

}  // namespace st
