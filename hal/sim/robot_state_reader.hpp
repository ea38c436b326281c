// Reads where the simulated Create is from the file it publishes.
#pragma once

#include <cstdint>
#include <string>

#include "algo/core/pose.hpp"
#include "hal/create/sim_state_file.hpp"

namespace st::sim {

class RobotStateReader {
 public:
  // Throws Failure (kDeviceFault) when it is not a state file.
  explicit RobotStateReader(const std::string& path) : ring_(path) {}

  // The robot's pose at that instant, interpolated; beyond the newest entry carried on at its speed for up to
  // 50 ms, before the oldest one the oldest. False while nothing has been written.
  bool pose_at(std::int64_t monotonic_ns, Pose2& pose) const;

 private:
  SimStateReader ring_;
};

}  // namespace st::sim
