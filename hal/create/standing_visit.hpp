// A visit to a robot that stands: its sensors are asked for, its lights and sounds are used, its wheels are
// left alone. No guard is needed, since there is nothing to stop.
#pragma once

#include <span>

#include "hal/create/handshake.hpp"
#include "hal/create/oi_stream.hpp"

namespace st {

class StandingVisit {
 public:
  // Meets the robot. Throws Failure (kDeviceFault).
  explicit StandingVisit(const RobotOptions& options);
  ~StandingVisit();  // leaves it in Passive mode, in which it charges
  StandingVisit(const StandingVisit&) = delete;
  StandingVisit& operator=(const StandingVisit&) = delete;

  RobotModel model() const { return identity_.model; }
  // Every sensor at once, by query: an answer without header or checksum, taken when it has its length.
  // Throws Failure when it does not come.
  SensorState all_sensors();
  // In Safe mode, entered when the first one is sent.
  void send(const oi::Command& command);

 private:
  RobotLogWriter no_log_;
  RobotPort port_;
  RobotIdentity identity_;
  bool safe_ = false;
};

}  // namespace st
