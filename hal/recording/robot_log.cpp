#include "hal/recording/robot_log.hpp"

#include <cstdio>

#include "hal/recording/text.hpp"

namespace st {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

LineKind parse_robot_log_line(std::string_view line, RobotLogEntry& entry) {
  line = trimmed(line);
  if (line.empty() || line.front() == '#') return LineKind::kBlank;
  const std::string_view stamp = take_word(line);
  const std::string_view direction = take_word(line);
  if (!parse_number(stamp, entry.t_s) || (direction != "rx" && direction != "tx")) return LineKind::kForeign;
  entry.rx = direction == "rx";
  entry.bytes.clear();
  int high = -1;
  for (const char c : line) {
    if (is_blank(c)) continue;
    const int digit = hex_digit(c);
    if (digit < 0) return LineKind::kForeign;
    if (high < 0) {
      high = digit;
    } else {
      entry.bytes.push_back(static_cast<std::uint8_t>(high << 4 | digit));
      high = -1;
    }
  }
  return high >= 0 || entry.bytes.empty() ? LineKind::kForeign : LineKind::kEntry;
}

std::optional<RobotModel> parse_robot_log_model(std::string_view first_line) {
  std::string_view rest = trimmed(first_line);
  if (take_word(rest) != "#" || take_word(rest) != "model") return std::nullopt;
  const std::string_view model = take_word(rest);
  if (model == "create1") return RobotModel::kCreate1;
  if (model == "create2") return RobotModel::kCreate2;
  return std::nullopt;
}

std::optional<RobotGeometry> parse_robot_log_wheels(std::string_view line) {
  std::string_view rest = trimmed(line);
  RobotGeometry wheels;
  if (take_word(rest) != "#" || take_word(rest) != "wheels") return std::nullopt;
  for (double* value : {&wheels.wheel_base_m, &wheels.wheel_diameter_m, &wheels.counts_per_turn})
    if (!parse_number(take_word(rest), *value) || !(*value > 0 && *value < 1e6)) return std::nullopt;
  const std::string_view ratio = take_word(rest);
  if (!ratio.empty() && (!parse_number(ratio, wheels.right_to_left) ||
                         !(wheels.right_to_left > 0.5 && wheels.right_to_left < 2)))
    return std::nullopt;
  return wheels;
}

std::string robot_log_first_line(RobotModel model) {
  return model == RobotModel::kCreate1 ? "# model create1\n" : "# model create2\n";
}

std::string robot_log_wheels_line(const RobotGeometry& geometry) {
  char line[100];
  std::snprintf(line, sizeof line, "# wheels %.9g %.9g %.9g %.9g\n", geometry.wheel_base_m,
                geometry.wheel_diameter_m, geometry.counts_per_turn, geometry.right_to_left);
  return line;
}

std::string format_robot_log_line(double t_s, bool rx, std::span<const std::uint8_t> bytes) {
  static constexpr char kHex[] = "0123456789abcdef";
  char stamp[40];
  std::snprintf(stamp, sizeof stamp, "%.6f %s ", t_s, rx ? "rx" : "tx");
  std::string line = stamp;
  for (const std::uint8_t b : bytes) {
    line += kHex[b >> 4];
    line += kHex[b & 15];
  }
  return line + "\n";
}

bool RobotLogReader::open(const std::string& path) {
  LineReader head;
  std::string_view line;
  if (!head.open(path)) return false;
  if (head.next(line)) model_ = parse_robot_log_model(line);
  if (head.next(line)) geometry_ = parse_robot_log_wheels(line);
  return lines_.open(path);
}

bool RobotLogReader::peek() {
  std::string_view line;
  while (!has_ahead_ && lines_.next(line)) {
    const LineKind kind = parse_robot_log_line(line, ahead_);
    if (kind == LineKind::kForeign) ++bad_lines_;
    has_ahead_ = kind == LineKind::kEntry;
    ahead_offset_ = lines_.offset();
  }
  return has_ahead_;
}

void RobotLogReader::pump_until_time(double t_s, const RobotBytes& sink) {
  for (; peek() && ahead_.t_s <= t_s; has_ahead_ = false) sink(ahead_.t_s, ahead_.rx, ahead_.bytes);
}

void RobotLogReader::pump_until_offset(std::uint64_t offset, const RobotBytes& sink) {
  for (; peek() && ahead_offset_ < offset; has_ahead_ = false) sink(ahead_.t_s, ahead_.rx, ahead_.bytes);
}

}  // namespace st
