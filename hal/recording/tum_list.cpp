#include "hal/recording/tum_list.hpp"

#include <cmath>

#include "hal/recording/text.hpp"

namespace st {
namespace {

constexpr double kMaxTime_s = 1e11;

bool stays_inside(std::string_view path) {
  if (path.empty() || path.front() == '/' || path.size() > 1024) return false;
  if (path.find('\0') != std::string_view::npos) return false;
  while (!path.empty()) {
    const std::size_t slash = path.find('/');
    if (path.substr(0, slash) == "..") return false;
    path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  }
  return true;
}

}  // namespace

LineKind parse_list_line(std::string_view line, ListEntry& entry) {
  line = trimmed(line);
  if (line.empty() || line.front() == '#') return LineKind::kBlank;
  const std::string_view stamp = take_word(line);
  entry.path = take_word(line);
  if (!parse_number(stamp, entry.t_s) || std::fabs(entry.t_s) > kMaxTime_s) return LineKind::kForeign;
  return stays_inside(entry.path) ? LineKind::kEntry : LineKind::kForeign;
}

}  // namespace st
