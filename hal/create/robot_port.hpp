// A robot's port while nobody guards it yet. Every error says what to do. The Open Interface wants one write
// per command, so writes are whole or fail.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "hal/create/port_address.hpp"

namespace st {

class RobotPort {
 public:
  // Opens a device (or pseudo-terminal) and claims it alone, or connects to a guard elsewhere. Throws Failure
  // (kDeviceFault): no such port, no permission, in use, not a serial port, nobody listens there.
  // `baud`: of a handshake it is the first that is tried.
  explicit RobotPort(const std::string& path, int baud = 115200);
  ~RobotPort();
  RobotPort(const RobotPort&) = delete;
  RobotPort& operator=(const RobotPort&) = delete;

  // Also discards what is on its way in. The guard at the other end of a connection has its own speed.
  void set_baud(int baud);
  // Waits up to 200 ms for room. Throws Failure when the device is gone or takes nothing.
  void write(std::span<const std::uint8_t> bytes);
  // Bytes read, 0 after the time-out. Throws Failure when the device is gone.
  std::size_t read(std::span<std::uint8_t> into, int timeout_ms);
  // One long pulse on the line that the robot's cable wires to its BRC pin (RTS): a sleeping Create 2 wakes
  // from it. One, since three short ones would set 19200 baud. False where there is no such line.
  bool pulse_wake_line();

  int fd() const { return fd_; }
  const std::string& path() const { return address_.text; }
  const PortAddress& address() const { return address_; }

 private:
  [[noreturn]] void gone() const;

  PortAddress address_;
  int fd_ = -1;
};

}  // namespace st
