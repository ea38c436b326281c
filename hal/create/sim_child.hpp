// PORT `sim[:SWITCH=VALUE,...]`: this program's own `create-sim` as a child process, with those of its
// switches.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "hal/create/drive_base.hpp"

namespace st {

bool is_simulated(const std::string& port);

class SimChild {
 public:
  // Starts it and waits for its pseudo-terminal. The program run is this one (/proc/self/exe), or what the
  // environment's STARTRACK_BINARY names. Throws Failure (kDeviceFault) when it does not come up, as for a
  // switch that it does not know: what is wrong with that it says itself, on stderr.
  SimChild(const std::string& port, RobotModel model, std::uint64_t seed);
  ~SimChild();  // the simulated robot ends once nobody holds its lifeline
  SimChild(const SimChild&) = delete;
  SimChild& operator=(const SimChild&) = delete;

  const std::string& port() const { return port_; }
  // Of its SimStateRing, as this process can open it: the file has no name, so that nothing is left behind.
  std::string state_path() const;
  // A copy of this keeps the robot alive: the guard holds one, so that a killed program's robot is seen to
  // stop.
  int lifeline() const { return lifeline_; }

 private:
  void read_port(int from);

  pid_t pid_ = -1;
  int state_ = -1, lifeline_ = -1;
  std::string port_;
};

// Waits until the child has ended, at most so long; true when it has. Leaves no zombie.
bool wait_for_child(pid_t pid, int timeout_ms);

}  // namespace st
