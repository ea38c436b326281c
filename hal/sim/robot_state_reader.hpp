// Reads where the simulated Create is from the file it publishes.
#pragma once

#include <cstdint>
#include <string>

#include "algo/core/pose.hpp"
#include "hal/create/sim_state.hpp"

namespace st::sim {

class RobotStateReader {
 public:
  // Maps the file. Throws Failure (kDeviceFault) when it is not a state file.
  explicit RobotStateReader(const std::string& path);
  ~RobotStateReader();
  RobotStateReader(const RobotStateReader&) = delete;
  RobotStateReader& operator=(const RobotStateReader&) = delete;

  // The robot's pose at that instant, interpolated; beyond the newest entry carried on at its speed for up to
  // 50 ms, before the oldest one the oldest. False while nothing has been written.
  bool pose_at(std::int64_t monotonic_ns, Pose2& pose) const;

 private:
  const SimStateRing* ring_ = nullptr;
};

}  // namespace st::sim
