// Decides, tick by tick, whether the robot may drive on: the rules of hal/create/safety_rules.hpp that
// concern a program that is alive. Without I/O and clock.
#pragma once

#include "algo/control/path.hpp"
#include "hal/create/safety_rules.hpp"

namespace st {

// What the camera makes of the robot in the newest frame.
struct Sight {
  bool watched = false;  // there is a camera at all
  bool sees = false;     // something has a good pose
  double age_s = 0;      // of the frame
};

class SafetySupervisor {
 public:
  explicit SafetySupervisor(Reaction on_bump) : on_bump_(on_bump) {}

  // `told`: what the wheels were last told to do, and go on doing. kNone: drive. kHold: stand in this tick.
  // kEnd: stand, and do not drive again.
  Reaction judge(double now_s, const RobotStatus& status, const Sight& sight, const WheelSpeeds& told);

  // Why it stands or holds.
  RobotFault fault() const { return fault_; }

 private:
  Reaction judge_robot(double now_s, RobotFault fault);
  bool blind_too_long(double now_s, const Sight& sight, const WheelSpeeds& told);

  Reaction on_bump_;
  bool ended_ = false, seen_ = false;
  RobotFault fault_ = RobotFault::kNone;
  double last_s_ = -1, hold_until_s_ = -1;
  double blind_s_ = 0, blind_m_ = 0;
};

}  // namespace st
