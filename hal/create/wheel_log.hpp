// The wheel travel that a recording's robot.log tells of.
#pragma once

#include <string>
#include <vector>

#include "hal/create/drive_base.hpp"

namespace st {

struct WheelLog {
  RobotModel model = RobotModel::kCreate2;
  RobotGeometry wheels;  // by which the travel is counted
  std::vector<OdometrySample> travel;
};

// By the wheels that the run was driven with, or, where travel of several runs of one robot is to be put
// together, by those of `first`. Throws Failure (kBadInput) when there is no log or when it is that of
// another model than `first`.
WheelLog read_wheel_log(const std::string& recording, const WheelLog* first);

}  // namespace st
