// robot.log: every byte that went to and came from the robot. First line `# model create1|create2`; where the
// robot's wheels were measured, `# wheels BASE_M DIAMETER_M COUNTS_PER_TURN [RIGHT_TO_LEFT]`; then lines
// `host_seconds rx|tx hex`.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algo/core/records.hpp"
#include "hal/create/drive_base.hpp"
#include "hal/recording/line_reader.hpp"

namespace st {

struct RobotLogEntry {
  double t_s = 0;
  bool rx = false;                  // from the robot
  std::vector<std::uint8_t> bytes;  // never empty
};

LineKind parse_robot_log_line(std::string_view line, RobotLogEntry& entry);
std::optional<RobotModel> parse_robot_log_model(std::string_view first_line);

std::optional<RobotGeometry> parse_robot_log_wheels(std::string_view line);

std::string robot_log_first_line(RobotModel model);                                           // with LF
std::string robot_log_wheels_line(const RobotGeometry& geometry);                             // with LF
std::string format_robot_log_line(double t_s, bool rx, std::span<const std::uint8_t> bytes);  // with LF

// Takes the bytes in order. An OdometryDecoder makes one, for the given robot, that hands wheel travel on as
// it decodes it; the code that knows the robot's protocol supplies it.
using RobotBytes = std::function<void(double t_s, bool rx, std::span<const std::uint8_t> bytes)>;
using OdometrySink = std::function<void(const OdometrySample&)>;
using OdometryDecoder = std::function<RobotBytes(
    RobotModel model, const std::optional<RobotGeometry>& geometry, OdometrySink sink)>;

class RobotLogReader {
 public:
  // False when there is no such file.
  bool open(const std::string& path);
  bool is_open() const { return lines_.is_open(); }
  std::optional<RobotModel> model() const { return model_; }
  const std::optional<RobotGeometry>& geometry() const { return geometry_; }  // none: the model's own

  // Hands on every line up to and with that host time / that begins before that byte offset.
  void pump_until_time(double t_s, const RobotBytes& sink);
  void pump_until_offset(std::uint64_t offset, const RobotBytes& sink);
  std::uint64_t bad_lines() const { return bad_lines_; }

 private:
  bool peek();

  LineReader lines_;
  std::optional<RobotModel> model_;
  std::optional<RobotGeometry> geometry_;
  RobotLogEntry ahead_;
  std::uint64_t ahead_offset_ = 0, bad_lines_ = 0;
  bool has_ahead_ = false;
};

}  // namespace st
