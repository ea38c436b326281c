// The guard at the robot's end of a network: for the computer that rides on the robot. It holds the robot's
// port through a guard process of its own, and lets one program at a time talk to the robot over TCP. A
// program that falls silent, a connection that breaks and a network that goes away all end in a standing
// robot.
#pragma once

#include <string>

#include "hal/create/command_reader.hpp"
#include "hal/create/guard.hpp"

namespace st {

class RemoteGuard {
 public:
  // Meets the robot, and listens at `address`, `[HOST:]PORT`: without a host for programs on this computer
  // only. Throws Failure.
  RemoteGuard(const RobotOptions& robot, const std::string& address);
  ~RemoteGuard();
  RemoteGuard(const RemoteGuard&) = delete;
  RemoteGuard& operator=(const RemoteGuard&) = delete;

  RobotModel model() const { return model_; }
  int port() const;  // that it listens at
  // Until a signal comes or the guard process ends. True: a signal.
  bool serve();

 private:
  void accept_program();
  void part_from_program();
  void from_program();
  bool from_robot();

  RobotModel model_ = RobotModel::kCreate2;
  Guard guard_;
  int listener_ = -1, program_ = -1;
  oi::CommandReader commands_{model_};
};

}  // namespace st
