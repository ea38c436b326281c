#include "hal/recording/frames_csv.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace st;
using namespace st::fuzz;

ST_FUZZ(frames_csv, "325833121,326821314,2,1234", "1,,0,0",
        "depth_ticks,colour_ticks,level,robot_log_offset") {
  FramesRow row, again;
  if (!parse_frames_row(text_of(data), row)) return;
  const std::string line = format_frames_row(row);
  require(parse_frames_row(std::string_view(line).substr(0, line.size() - 1), again),
          "what is written is read");
  require(again.color_ticks == row.color_ticks && again.robot_log_offset == row.robot_log_offset,
          "values survive");
}
