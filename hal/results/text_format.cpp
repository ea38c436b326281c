#include "hal/results/text_format.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace st {
namespace {

// Large enough for any double in fixed notation: 309 digits before the point.
constexpr std::size_t kLongest = 352;

void append_without_minus_zero(std::string& out, const char* begin, const char* end) {
  if (begin != end && *begin == '-') {
    bool zero = true;
    for (const char* c = begin + 1; c != end && *c != 'e'; ++c) zero = zero && (*c == '0' || *c == '.');
    if (zero) ++begin;
  }
  out.append(begin, end);
}

void append_formatted(std::string& out, double value, std::chars_format format, int decimals) {
  if (!std::isfinite(value)) return;
  char text[kLongest];
  const std::to_chars_result result = std::to_chars(text, text + sizeof text, value, format, decimals);
  append_without_minus_zero(out, text, result.ptr);
}

}  // namespace

void append_fixed(std::string& out, double value, int decimals) {
  append_formatted(out, value, std::chars_format::fixed, decimals);
}

void append_scientific(std::string& out, double value, int decimals) {
  append_formatted(out, value, std::chars_format::scientific, decimals);
}

void append_yaw(std::string& out, double yaw_rad) {
  constexpr double kLargestBelowPi = 3.141592;
  if (std::isfinite(yaw_rad)) yaw_rad = std::clamp(yaw_rad, -kLargestBelowPi, kLargestBelowPi);
  append_fixed(out, yaw_rad, kRadianDecimals);
}

void append_integer(std::string& out, std::int64_t value) {
  char text[24];
  const std::to_chars_result result = std::to_chars(text, text + sizeof text, value);
  out.append(text, result.ptr);
}

}  // namespace st
