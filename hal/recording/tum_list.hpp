// Lines of TUM RGB-D lists (depth.txt, rgb.txt): `timestamp path`, `#` begins a comment.
#pragma once

#include <string_view>

#include "hal/recording/line_reader.hpp"

namespace st {

struct ListEntry {
  double t_s = 0;
  std::string_view path;  // relative to the recording's folder; points into what was parsed
};

// A path that is absolute or climbs out of the folder makes the line foreign. Further columns are ignored.
LineKind parse_list_line(std::string_view line, ListEntry& entry);

}  // namespace st
