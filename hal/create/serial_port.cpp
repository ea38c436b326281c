#include "hal/create/serial_port.hpp"

#include <fcntl.h>
#include <glob.h>
#include <grp.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hal/error.hpp"

namespace st {
namespace {

constexpr int kWriteWait_ms = 200;

speed_t speed_of(int baud) {
  switch (baud) {
    case 9600:
      return B9600;
    case 19200:
      return B19200;
    case 38400:
      return B38400;
    case 57600:
      return B57600;
    case 115200:
      return B115200;
  }
  throw Failure(ExitCode::kBadInput,
                "no serial speed of " + std::to_string(baud) + " baud; use 19200, 57600 or 115200");
}

std::string ports_present() {
  glob_t found{};
  std::string list;
  const char* patterns[] = {"/dev/ttyUSB*", "/dev/ttyACM*", "/dev/rfcomm*"};
  for (std::size_t i = 0; i < std::size(patterns); ++i)
    glob(patterns[i], i == 0 ? 0 : GLOB_APPEND, nullptr, &found);
  for (std::size_t i = 0; i < found.gl_pathc; ++i)
    list += std::string(list.empty() ? "" : ", ") + found.gl_pathv[i];
  globfree(&found);
  return list.empty() ? "no USB serial port is present: plug the robot's cable in" : "present: " + list;
}

std::string group_that_may(const std::string& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) return "dialout";
  const group* owner = getgrgid(about.st_gid);
  return owner != nullptr ? owner->gr_name : std::to_string(about.st_gid);
}

[[noreturn]] void cannot_open(const std::string& path, int error) {
  const std::string where = "robot port " + path + ": ";
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      throw Failure(ExitCode::kDeviceFault, where + "no such port; " + ports_present());
    case EACCES:
    case EPERM: {
      const std::string group_name = group_that_may(path);
      throw Failure(ExitCode::kDeviceFault, where + "no permission; run `sudo usermod -aG " + group_name +
                                                " $USER`, then log out and in");
    }
    case EBUSY:
    case EWOULDBLOCK:
      throw Failure(ExitCode::kDeviceFault,
                    where + "in use by another program; end it (`fuser " + path + "` shows it)");
    case ENOTTY:
      throw Failure(ExitCode::kDeviceFault, where + "not a serial port; " + ports_present());
  }
  throw Failure(ExitCode::kDeviceFault, where + std::strerror(error));
}

// 8N1, no flow control, every byte as it is. The modem lines stay as they are at the end: RTS is the robot's
// BRC pin.
void make_raw(termios& mode, int baud) {
  cfmakeraw(&mode);
  mode.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | CRTSCTS | HUPCL);
  mode.c_cflag |= CLOCAL | CREAD | CS8;
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  cfsetspeed(&mode, speed_of(baud));
}

// USB adapters gather bytes for 16 ms by default, which is more than the robot's 15 ms slot. Pseudo-terminals
// and some drivers have no such setting: frames then come in bursts, and nothing else is lost.
void ask_for_low_latency(int fd) {
  serial_struct settings{};
  if (ioctl(fd, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  ioctl(fd, TIOCSSERIAL, &settings);
}

}  // namespace

SerialPort::SerialPort(const std::string& path, int baud) : path_(path) {
  fd_ = open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) cannot_open(path, errno);
  termios mode{};
  int error = 0;
  // TIOCEXCL does not bind root, so the lock stands beside it.
  if (tcgetattr(fd_, &mode) != 0)
    error = ENOTTY;
  else if (flock(fd_, LOCK_EX | LOCK_NB) != 0 || ioctl(fd_, TIOCEXCL) != 0)
    error = errno;
  if (error != 0) {
    close(fd_);
    cannot_open(path, error);
  }
  try {
    set_baud(baud);
  } catch (...) {
    close(fd_);
    throw;
  }
  ask_for_low_latency(fd_);
}

SerialPort::~SerialPort() { close(fd_); }

void SerialPort::set_baud(int baud) {
  termios mode{};
  if (tcgetattr(fd_, &mode) != 0) gone();
  make_raw(mode, baud);
  if (tcsetattr(fd_, TCSANOW, &mode) != 0) gone();
  tcflush(fd_, TCIFLUSH);
}

void SerialPort::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(n));
      continue;
    }
    if (errno == EINTR) continue;
    pollfd ready{fd_, POLLOUT, 0};
    if (errno != EAGAIN || poll(&ready, 1, kWriteWait_ms) <= 0) gone();
  }
}

std::size_t SerialPort::read(std::span<std::uint8_t> into, int timeout_ms) {
  pollfd ready{fd_, POLLIN, 0};
  const int events = poll(&ready, 1, timeout_ms);
  if (events == 0 || (events < 0 && errno == EINTR)) return 0;
  const ssize_t n = ::read(fd_, into.data(), into.size());
  if (n > 0) return static_cast<std::size_t>(n);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  gone();
}

void SerialPort::gone() const {
  throw Failure(ExitCode::kDeviceFault,
                "robot port " + path_ + ": the port went away; check the cable and plug it in again");
}

}  // namespace st
