#include "hal/create/robot_port.hpp"

#include <glob.h>
#include <grp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hal/error.hpp"

namespace st {
namespace {

constexpr int kConnect_ms = 3000;
constexpr int kWriteWait_ms = 200;
constexpr timespec kWakePulse{0, 500'000'000};

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
    case ECONNREFUSED:
    case ETIMEDOUT:
    case EHOSTUNREACH:
    case ENETUNREACH:
      throw Failure(ExitCode::kDeviceFault, where + std::strerror(error) +
                                                "; on the robot's computer run `startrack drive --guard "
                                                "--robot PORT --listen ADDRESS:PORT`");
    case ENOTTY:
      throw Failure(ExitCode::kDeviceFault, where + "not a serial port; " + ports_present());
  }
  throw Failure(ExitCode::kDeviceFault, where + std::strerror(error));
}

}  // namespace

RobotPort::RobotPort(const std::string& path, int baud) : address_(port_address(path, baud)) {
  fd_ = open_port(address_, kConnect_ms);
  if (fd_ < 0) cannot_open(path, -fd_);
}

RobotPort::~RobotPort() { close(fd_); }

void RobotPort::set_baud(int baud) {
  address_.baud = baud;
  if (address_.tcp) return;
  if (set_line(fd_, baud) != 0) gone();
  tcflush(fd_, TCIFLUSH);
}

bool RobotPort::pulse_wake_line() {
  const int line = TIOCM_RTS;
  int before = 0;
  if (address_.tcp || ioctl(fd_, TIOCMGET, &before) != 0) return false;
  const bool was_set = (before & line) != 0;
  if (ioctl(fd_, was_set ? TIOCMBIC : TIOCMBIS, &line) != 0) return false;
  nanosleep(&kWakePulse, nullptr);
  ioctl(fd_, was_set ? TIOCMBIS : TIOCMBIC, &line);
  nanosleep(&kWakePulse, nullptr);
  return true;
}

void RobotPort::write(std::span<const std::uint8_t> bytes) {
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

std::size_t RobotPort::read(std::span<std::uint8_t> into, int timeout_ms) {
  pollfd ready{fd_, POLLIN, 0};
  const int events = poll(&ready, 1, timeout_ms);
  if (events == 0 || (events < 0 && errno == EINTR)) return 0;
  const ssize_t n = ::read(fd_, into.data(), into.size());
  if (n > 0) return static_cast<std::size_t>(n);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  gone();
}

void RobotPort::gone() const {
  throw Failure(ExitCode::kDeviceFault,
                "robot port " + address_.text +
                    (address_.tcp ? ": the connection ended; see what the guard at the robot's end says"
                                  : ": the port went away; check the cable and plug it in again"));
}

}  // namespace st
