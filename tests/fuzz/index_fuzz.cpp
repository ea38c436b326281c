#include <cmath>

#include "hal/recording/fakenect_index.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace st;
using namespace st::fuzz;

ST_FUZZ(index, "d-1298914300.730607-325833121.pgm", "r-1298914300.740118-326821314.ppm\r",
        "a-0.0-4294967295.dump", "d-1-2") {
  IndexEntry entry;
  if (parse_index_line(text_of(data), entry) != LineKind::kEntry) return;
  require(entry.name.find('/') == std::string_view::npos, "a name stays in its folder");
  require(std::isfinite(entry.host_s) && entry.host_s >= 0, "host seconds are a time");
  IndexEntry again;
  const std::string name = fakenect_name(entry.type, entry.host_s, entry.ticks);
  require(parse_index_line(name, again) == LineKind::kEntry, "what is written is read");
  require(again.ticks == entry.ticks && again.type == entry.type, "ticks and type survive");
}
