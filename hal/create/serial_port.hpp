// A serial port in raw 8N1 mode. Every error says what to do. The Open Interface wants one write per command,
// so writes are whole or fail.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace st {

class SerialPort {
 public:
  // Opens a device (or pseudo-terminal) and claims it alone. Throws Failure (kDeviceFault): no such port, no
  // permission, in use, not a serial port.
  SerialPort(const std::string& path, int baud);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  void set_baud(int baud);  // also discards what is on its way in
  // Waits up to 200 ms for room. Throws Failure when the device is gone or takes nothing.
  void write(std::span<const std::uint8_t> bytes);
  // Bytes read, 0 after the time-out. Throws Failure when the device is gone.
  std::size_t read(std::span<std::uint8_t> into, int timeout_ms);

  int fd() const { return fd_; }
  const std::string& path() const { return path_; }

 private:
  [[noreturn]] void gone() const;

  std::string path_;
  int fd_ = -1;
};

}  // namespace st
