// Drives the robot while the loop runs, as long as the safety supervisor lets it: the preset path by dead
// reckoning (open loop), or on the pose at which it is seen (closed loop), or what a client asks for. It
// waits until the background is learned. Before anything but an open loop, a start motion tells which of the
// tracked objects is the robot. Every command is the heartbeat that keeps the guard from stopping the robot.
#pragma once

#include <optional>

#include "algo/control/base_tracker.hpp"
#include "algo/control/follower.hpp"
#include "algo/control/pose_follower.hpp"
#include "algo/control/wheel_trail.hpp"
#include "firmware_like/safety_supervisor.hpp"
#include "hal/create/drive_base.hpp"
#include "hal/serve/client_command.hpp"
#include "hal/serve/served_frame.hpp"

namespace st {

enum class Steering : std::uint8_t { kOpenLoop, kClosedLoop, kClient };

// What a frame tells the driver.
struct DriverView {
  Sight sight;           // `sees`: anything at all; the driver narrows it to the robot once that is known
  WheelOdometry wheels;  // since the frame before
  SeenObjects objects;
  const WheelTrail* trail = nullptr;
  double t_s = 0;         // the frame's stamp
  double host_now_s = 0;  // on the clock of the trail
};

class RobotDriver {
 public:
  // Robot, path and command outlive the driver. `path`: null for a client; `command`: null without one.
  RobotDriver(DriveBase& robot, Steering steering, const Path* path, NewestCommand* command,
              Reaction on_bump);

  // What the robot has told since the last call; once a frame, before decide().
  void listen(FixedVector<OdometrySample, 64>& odometry);
  // What the wheels are to do until the next frame. `now_s`: any steady clock.
  void decide(double now_s, const DriverView& view);
  void send() { robot_.drive(speeds_.left_mps, speeds_.right_mps); }
  void stop() { robot_.stop(); }
  // No frame has come for a while: the robot stands until one does.
  void wait_without_frame(double now_s);

  // Why the drive was given up; kNone: it was not.
  RobotFault fault() const { return held_ == Reaction::kEnd ? held_by() : RobotFault::kNone; }
  // What holds the robot in this frame, for good or for a while.
  RobotFault held_by() const { return never_obeyed_ ? RobotFault::kNotSeen : supervisor_.fault(); }
  const RobotStatus& status() const { return status_; }
  double wheel_base_m() const { return robot_.geometry().wheel_base_m; }
  bool finished(double now_s) const;  // the path is driven, and the robot has stood for a while

  // The object that answered to the start motion; id 0 until then, and in an open loop.
  const Obedience& picked() const { return picked_; }
  // Recording time from which on what it drives is the path; -1: from the first motion on.
  double path_begins_t_s() const { return path_begins_t_s_; }

  // All that a client is told of the robot.
  ServedRobot served() const;

  static constexpr double kStillBefore_s = 1.5;  // for the background to be learned
  static constexpr double kStillAfter_s = 1.0;
  static constexpr int kStartMotions = 6;  // tries, after which nothing obeys

 private:
  enum class Phase : std::uint8_t { kLearning, kStartMotion, kLaying, kDriving, kDone };

  void watch(const DriverView& view, double passed_s);
  WheelSpeeds next_speeds(double now_s, const DriverView& view, double passed_s);
  WheelSpeeds start_motion_speeds(double now_s, const DriverView& view, double passed_s);
  WheelSpeeds dead_reckoned(double passed_s);
  WheelSpeeds path_speeds(double passed_s);
  WheelSpeeds client_speeds(double now_s);
  void enter(Phase phase, double now_s);
  void hold(double passed_s);
  const SeenObject* robot_in(const SeenObjects& objects) const;

  DriveBase& robot_;
  Steering steering_;
  const Path* path_;
  NewestCommand* command_;
  SafetySupervisor supervisor_;
  Reaction held_ = Reaction::kNone;
  WheelSpeeds speeds_;
  WheelSpeeds led_;  // by which it was led since the frame before, a stop for want of a frame aside
  RobotStatus status_;

  Phase phase_ = Phase::kLearning;
  double phase_since_s_ = -1, last_s_ = 0;
  bool stood_ = false;  // it was stopped since the last frame, and the path's time with it
  Path start_path_ = start_motion();
  std::optional<OpenLoopFollower> open_;  // of the start motion, or of the path in an open loop
  std::optional<PoseFollower> closed_;
  Pose2 T_floor_path_;
  StartWitness witness_;
  int start_motions_ = 0;
  double start_forward_m_ = 0, start_turn_rad_ = 0;  // by the wheels, since the first start motion began
  bool never_obeyed_ = false;
  Obedience picked_;
  double path_begins_t_s_ = -1;
  BaseTracker base_;
  Pose2 base_now_;  // carried on to when the next command acts
};

}  // namespace st
