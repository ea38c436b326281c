// frames.csv of a live run's recording: which colour frame and which degradation level each depth frame was
// processed with, and how much of robot.log had arrived by then.
// `depth_ticks,colour_ticks,level,robot_log_offset`; colour_ticks is empty when there was no colour.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/recording/line_reader.hpp"

namespace st {

inline constexpr const char* kFramesCsvHeader = "depth_ticks,colour_ticks,level,robot_log_offset";

struct FramesRow {
  std::uint32_t depth_ticks = 0;
  std::optional<std::uint32_t> color_ticks;
  int level = 0;
  std::uint64_t robot_log_offset = 0;
};

// False for the header and for what is no row.
bool parse_frames_row(std::string_view line, FramesRow& row);
std::string format_frames_row(const FramesRow& row);  // with LF

// Rows found by their depth frame, streaming. Frames without a row (never processed) and rows without a frame
// (not written to disk) are both met: a row is looked for among the next kWindow.
class FramesCsv {
 public:
  bool open(const std::string& path) { return lines_.open(path); }
  bool is_open() const { return lines_.is_open(); }
  std::optional<FramesRow> find(std::uint32_t depth_ticks);

 private:
  static constexpr std::size_t kWindow = 256;

  LineReader lines_;
  std::array<FramesRow, kWindow> window_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace st
