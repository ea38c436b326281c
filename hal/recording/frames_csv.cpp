#include "hal/recording/frames_csv.hpp"

#include <cstdio>

#include "hal/recording/text.hpp"

namespace st {
namespace {

std::string_view take_field(std::string_view& rest) {
  const std::size_t comma = rest.find(',');
  const std::string_view field = rest.substr(0, comma);
  rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  return trimmed(field);
}

}  // namespace

bool parse_frames_row(std::string_view line, FramesRow& row) {
  line = trimmed(line);
  if (!parse_number(take_field(line), row.depth_ticks)) return false;
  const std::string_view color = take_field(line);
  std::uint32_t color_ticks = 0;
  if (!color.empty() && !parse_number(color, color_ticks)) return false;
  row.color_ticks = color.empty() ? std::nullopt : std::optional(color_ticks);
  if (!parse_number(take_field(line), row.level) || row.level < 0) return false;
  return parse_number(take_field(line), row.robot_log_offset);
}

std::string format_frames_row(const FramesRow& row) {
  std::string line = std::to_string(row.depth_ticks) + ",";
  if (row.color_ticks) line += std::to_string(*row.color_ticks);
  return line + "," + std::to_string(row.level) + "," + std::to_string(row.robot_log_offset) + "\n";
}

std::optional<FramesRow> FramesCsv::find(std::uint32_t depth_ticks) {
  std::string_view line;
  while (count_ < kWindow && lines_.next(line))
    if (parse_frames_row(line, window_[(first_ + count_) % kWindow])) ++count_;
  for (std::size_t i = 0; i < count_; ++i) {
    const FramesRow row = window_[(first_ + i) % kWindow];
    if (row.depth_ticks != depth_ticks) continue;
    first_ = (first_ + i + 1) % kWindow;
    count_ -= i + 1;
    return row;
  }
  return std::nullopt;
}

}  // namespace st
