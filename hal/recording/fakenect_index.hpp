// Lines of a fakenect INDEX.txt: `T-<host seconds>-<ticks>.ext`, T one of d (depth), r (colour), a
// (accelerometer).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hal/recording/line_reader.hpp"

namespace st {

struct IndexEntry {
  char type = 0;  // 'd', 'r' or 'a'
  double host_s = 0;
  std::uint32_t ticks = 0;
  std::string_view name;  // the whole line; points into what was parsed
};

// `line` without its LF; a CR and blanks at the end are ignored. A name that would leave the folder is
// foreign.
LineKind parse_index_line(std::string_view line, IndexEntry& entry);

// The name of a new file of a recording; the extension follows from the type.
std::string fakenect_name(char type, double host_s, std::uint32_t ticks);

}  // namespace st
