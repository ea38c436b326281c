#include "hal/recording/pnm.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace st;
using namespace st::fuzz;

ST_FUZZ(pnm, "P5 640 480 65535\nxx", "P6\n# comment\n2 1\n255\nabcdef", "P5 1 1 65535   \nab") {
  const std::optional<PnmHeader> header = parse_pnm_header(data);
  if (!header) return;
  require(header->header_bytes <= data.size(), "the header lies in the file");
  require(header->width > 0 && header->width <= 65535 && header->height > 0 && header->height <= 65535,
          "a size");
  require(header->pixel_bytes() > 0, "there are pixels");
}
