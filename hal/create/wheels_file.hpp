// robot.toml: a robot's wheels and its camera's lag as measured, for --wheels FILE.
//
//   wheel_base_m = 0.2381
//   wheel_diameter_m = 0.0718
//   counts_per_turn = 508.8      # optional, as is everything
//   right_to_left = 1.0021       # size of the right wheel beside the left one
//   camera_lag_s = 0.035         # by how much the camera's stamps are later than the wheels' reports
#pragma once

#include <string>

#include "hal/create/drive_base.hpp"

namespace st {

struct MeasuredRobot {
  RobotGeometry wheels{0, 0, 0, 0};  // 0: not measured
  double camera_lag_s = 0;
};

// Throws Failure (kBadInput) with the line of what is unknown or makes no sense.
MeasuredRobot read_wheels_file(const std::string& path);
MeasuredRobot parse_wheels_toml(std::string_view text, const std::string& name);
std::string format_wheels_toml(const MeasuredRobot& robot);

}  // namespace st
