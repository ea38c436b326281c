// Wakes the robot and finds out what it is, before the guard takes the port. The robot stands meanwhile.
#pragma once

#include <optional>

#include "hal/create/drive_base.hpp"
#include "hal/create/robot_log_writer.hpp"
#include "hal/create/robot_port.hpp"

namespace st {

struct RobotIdentity {
  RobotModel model = RobotModel::kCreate2;
  int baud = 115200;
  // Some firmwares report the mode one too high: learnt while it must be Passive. Others report junk: not
  // trusted at all.
  int mode_offset = 0;
  bool mode_trusted = true;
};

// Throws Failure (kDeviceFault): no answer, not understood, or not the model that was told.
RobotIdentity meet_robot(RobotPort& port, std::optional<RobotModel> told, RobotLogWriter& log);

}  // namespace st
