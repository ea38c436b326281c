#include <cmath>
#include <filesystem>

#include "hal/recording/tum_list.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace st;
using namespace st::fuzz;

ST_FUZZ(tum_list, "0.033333 depth/000001.png", "# timestamp filename", "1305031102.160407 depth/../../x.png",
        "1 ./a//b") {
  ListEntry entry;
  if (parse_list_line(text_of(data), entry) != LineKind::kEntry) return;
  require(std::isfinite(entry.t_s), "the stamp is a time");
  const auto inside = std::filesystem::path("/base").append(entry.path).lexically_normal().string();
  require(inside.rfind("/base", 0) == 0, "a path stays in its folder");
}
