// Drives the preset path while the loop runs: waits until the background is learned, then sends the wheel
// speeds of the path, frame by frame. Every command is the heartbeat that keeps the guard from stopping the
// robot.
#pragma once

#include "algo/control/follower.hpp"
#include "hal/create/drive_base.hpp"

namespace st {

class PathDriver {
 public:
  // Both outlive the driver.
  PathDriver(DriveBase& robot, const Path& path);

  // What the wheels are to do until the next frame. `now_s`: any steady clock.
  void decide(double now_s);
  void send();
  void stop() { robot_.stop(); }

  RobotFault fault() const { return status_.fault; }
  const RobotStatus& status() const { return status_; }
  const FixedVector<OdometrySample, 64>& odometry() const { return odometry_; }
  bool finished(double now_s) const;  // the path is driven, and the robot has stood for a while

  static constexpr double kStillBefore_s = 1.5;  // for the background to be learned
  static constexpr double kStillAfter_s = 1.0;

 private:
  DriveBase& robot_;
  OpenLoopFollower follower_;
  WheelSpeeds speeds_;
  RobotStatus status_;
  FixedVector<OdometrySample, 64> odometry_;
  double first_s_ = -1, last_s_ = 0, done_s_ = -1;
};

}  // namespace st
