#include "hal/recording/robot_log.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace st;
using namespace st::fuzz;

ST_FUZZ(robot_log, "1400101000.030870 rx 1305 2b", "0.5 tx 8083", "# model create1", "# model create2\r") {
  parse_robot_log_model(text_of(data));
  RobotLogEntry entry;
  if (parse_robot_log_line(text_of(data), entry) != LineKind::kEntry || entry.t_s > 1e15 || entry.t_s < -1e15)
    return;
  RobotLogEntry again;
  const std::string line = format_robot_log_line(entry.t_s, entry.rx, entry.bytes);
  require(parse_robot_log_line(std::string_view(line).substr(0, line.size() - 1), again) == LineKind::kEntry,
          "what is written is read");
  require(again.bytes == entry.bytes && again.rx == entry.rx, "bytes and direction survive");
}
