// From the path to wheel speeds.
#pragma once

#include "algo/control/path.hpp"

namespace st {

// Open loop, by dead reckoning: what the wheels are told adds up to the path, whatever the ticks' jitter and
// however the robot rounds speeds, since each command covers what is still missing at the end of the coming
// tick.
class OpenLoopFollower {
 public:
  OpenLoopFollower(const Path& path, double wheel_base_m) : path_(&path), wheel_base_m_(wheel_base_m) {}

  // Once a tick: `passed_s` since the call before, during which the previous command was obeyed, and how long
  // the coming one is expected to hold. Speeds are whole mm/s, as the robot takes them.
  WheelSpeeds step(double passed_s, double tick_s);
  // Instead of a step: the robot is to stand from now on, and the path's time with it.
  void hold(double passed_s);

  double time_s() const { return time_s_; }
  bool done() const;  // the path's time is over and nothing is missing
  // How far the preset path is beside the time: where the robot should be now.
  PathSample target() const { return sample(*path_, time_s_); }

 private:
  WheelWay missing(double at_s) const;

  const Path* path_;
  double wheel_base_m_;
  double time_s_ = 0;
  WheelSpeeds commanded_;
  WheelWay rolled_;  // by what was commanded
};

}  // namespace st
