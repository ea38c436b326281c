// Small pieces of reading text, independent of the locale.
#pragma once

#include <charconv>
#include <cmath>
#include <string_view>

namespace st {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

inline std::string_view trimmed(std::string_view s) {
  while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
  return s;
}

// Takes the first blank-separated word off `rest`; empty when there is none.
inline std::string_view take_word(std::string_view& rest) {
  rest = trimmed(rest);
  std::size_t n = 0;
  while (n < rest.size() && !is_blank(rest[n])) ++n;
  const std::string_view word = rest.substr(0, n);
  rest.remove_prefix(n);
  return word;
}

// True when the whole of `s` is one number of type T; floating-point ones must be finite.
template <typename T>
bool parse_number(std::string_view s, T& value) {
  const auto result = std::from_chars(s.data(), s.data() + s.size(), value);
  if (result.ec != std::errc() || result.ptr != s.data() + s.size()) return false;
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
  return true;
}

}  // namespace st
