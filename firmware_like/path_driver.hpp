// Drives the preset path while the loop runs: waits until the background is learned, then sends the wheel
// speeds of the path, frame by frame, as long as the safety supervisor lets it. Every command is the
// heartbeat that keeps the guard from stopping the robot.
#pragma once

#include "algo/control/follower.hpp"
#include "firmware_like/safety_supervisor.hpp"
#include "hal/create/drive_base.hpp"

namespace st {

class PathDriver {
 public:
  // Robot and path outlive the driver.
  PathDriver(DriveBase& robot, const Path& path, Reaction on_bump);

  // What the robot has told since the last call; once a frame, before decide().
  void listen(FixedVector<OdometrySample, 64>& odometry) { robot_.poll(odometry, status_); }
  // What the wheels are to do until the next frame. `now_s`: any steady clock.
  void decide(double now_s, const Sight& sight);
  void send();
  void stop() { robot_.stop(); }
  // No frame has come for a while: the robot stands until one does.
  void wait_without_frame(double now_s);

  // Why the path was given up; kNone: it was not.
  RobotFault fault() const { return reaction_ == Reaction::kEnd ? supervisor_.fault() : RobotFault::kNone; }
  // What holds the robot in this frame, for good or for a while.
  RobotFault held_by() const { return supervisor_.fault(); }
  const RobotStatus& status() const { return status_; }
  double wheel_base_m() const { return robot_.geometry().wheel_base_m; }
  bool finished(double now_s) const;  // the path is driven, and the robot has stood for a while

  static constexpr double kStillBefore_s = 1.5;  // for the background to be learned
  static constexpr double kStillAfter_s = 1.0;

 private:
  DriveBase& robot_;
  OpenLoopFollower follower_;
  SafetySupervisor supervisor_;
  Reaction reaction_ = Reaction::kNone;
  WheelSpeeds speeds_;
  RobotStatus status_;
  double first_s_ = -1, last_s_ = 0, done_s_ = -1;
};

}  // namespace st
