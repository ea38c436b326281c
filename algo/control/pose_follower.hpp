// Closed loop: from the path and the pose at which the robot is seen to be, to wheel speeds. The path's own
// speeds are fed forward; what is missing along, across and in heading is fed back so that the errors die
// away over a distance on the path rather than a time, at any speed (nonlinear tracking of a moving
// reference, Kanayama et al. 1990, with the gains of De Luca, Oriolo and Vendittelli 2001).
#pragma once

#include "algo/control/path.hpp"
#include "algo/core/pose.hpp"

namespace st {

class PoseFollower {
 public:
  // The path outlives the follower.
  PoseFollower(const Path& path, double wheel_base_m) : path_(&path), wheel_base_m_(wheel_base_m) {}

  // `base` in the path's frame, at the moment at which the speeds will be obeyed; `passed_s` since the call
  // before, during which the path's time went on; `extra_turn_rpm`: how far the robot turns per metre beyond
  // what its wheels are told.
  WheelSpeeds step(const Pose2& base, double passed_s, double extra_turn_rpm);

  bool done() const;  // the path's time is over, and the robot is where it ends or has had its chance
  PathSample target() const { return sample(*path_, time_s_); }

 private:
  const Path* path_;
  double wheel_base_m_;
  double time_s_ = 0;
  bool arrived_ = false;
};

}  // namespace st
