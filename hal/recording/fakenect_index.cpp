#include "hal/recording/fakenect_index.hpp"

#include <cstdio>

#include "hal/recording/text.hpp"

namespace st {
namespace {

constexpr std::size_t kMaxNameLength = 255;  // of a file on Linux
constexpr double kMaxHost_s = 1e11;          // year 5138

}  // namespace

LineKind parse_index_line(std::string_view line, IndexEntry& entry) {
  const std::string_view name = trimmed(line);
  if (name.empty()) return LineKind::kBlank;
  const bool plain = name.find_first_of(std::string_view("/\\\0", 3)) == std::string_view::npos;
  if (!plain || name.size() > kMaxNameLength || name.size() < 5 || name[1] != '-') return LineKind::kForeign;
  if (name[0] != 'd' && name[0] != 'r' && name[0] != 'a') return LineKind::kForeign;
  const std::string_view stamps = name.substr(2);
  const std::size_t dash = stamps.find('-');
  if (dash == std::string_view::npos) return LineKind::kForeign;
  const std::string_view ticks = stamps.substr(dash + 1);
  if (!parse_number(stamps.substr(0, dash), entry.host_s)) return LineKind::kForeign;
  if (entry.host_s < 0 || entry.host_s > kMaxHost_s) return LineKind::kForeign;
  if (!parse_number(ticks.substr(0, ticks.find('.')), entry.ticks)) return LineKind::kForeign;
  entry.type = name[0];
  entry.name = name;
  return LineKind::kEntry;
}

std::string fakenect_name(char type, double host_s, std::uint32_t ticks) {
  const char* extension = type == 'd' ? "pgm" : type == 'r' ? "ppm" : "dump";
  char name[64];
  std::snprintf(name, sizeof name, "%c-%.6f-%u.%s", type, host_s, ticks, extension);
  return name;
}

}  // namespace st
