// From the path to wheel speeds.
#pragma once

#include "algo/control/path.hpp"

namespace st {

// Open loop, by dead reckoning: what the wheels are told adds up to the path, whatever the ticks' jitter and
// however the robot rounds speeds, since each command makes up for what is missing. No wheel is told to go
// faster than the path itself asks of any.
class OpenLoopFollower {
 public:
  // The path outlives the follower.
  OpenLoopFollower(const Path& path, double wheel_base_m);

  // Once a tick: `passed_s` since the call before, during which the previous command was obeyed, and how long
  // the coming one is expected to hold. Speeds are whole mm/s, as the robot takes them.
  WheelSpeeds step(double passed_s, double tick_s);
  // Instead of a step: the robot is to stand from now on, and the path's time with it.
  void hold(double passed_s);
  // After a step: the wheels were told something else than it said; the path's time goes on.
  void told(const WheelSpeeds& speeds) { commanded_ = speeds; }

  double time_s() const { return time_s_; }
  bool done() const;  // the path's time is over and nothing is missing
  // How far the preset path is beside the time: where the robot should be now.
  PathSample target() const { return sample(*path_, time_s_); }

 private:
  void roll(double passed_s);

  const Path* path_;
  double wheel_base_m_, fastest_mps_;
  double time_s_ = 0;
  WheelSpeeds commanded_;
  WheelWay rolled_;  // by what was commanded
};

}  // namespace st
