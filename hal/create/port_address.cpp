#include "hal/create/port_address.hpp"

#include <fcntl.h>
#include <linux/serial.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "hal/error.hpp"

namespace st {
namespace {

constexpr std::string_view kTcp = "tcp:";

speed_t speed_of(int baud) {
  switch (baud) {
    case 19200:
      return B19200;
    case 57600:
      return B57600;
    default:
      return B115200;
  }
}

// USB adapters gather bytes for 16 ms by default, which is more than the robot's 15 ms slot. Pseudo-terminals
// and some drivers have no such setting: frames then come in bursts, and nothing else is lost.
void ask_for_low_latency(int fd) {
  serial_struct settings{};
  if (ioctl(fd, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  ioctl(fd, TIOCSSERIAL, &settings);
}

int open_device(const PortAddress& address) {
  const int fd = open(address.device, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return -errno;
  termios mode{};
  int error = 0;
  // TIOCEXCL does not bind root, so the lock stands beside it.
  if (tcgetattr(fd, &mode) != 0)
    error = ENOTTY;
  else if (flock(fd, LOCK_EX | LOCK_NB) != 0 || ioctl(fd, TIOCEXCL) != 0)
    error = errno;
  else
    error = set_line(fd, address.baud);
  if (error != 0) {
    close(fd);
    return -error;
  }
  ask_for_low_latency(fd);
  return fd;
}

int open_connection(const PortAddress& address, int connect_ms) {
  const int fd = socket(address.host.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return -errno;
  int error = 0;
  if (connect(fd, reinterpret_cast<const sockaddr*>(&address.host), address.host_size) != 0) error = errno;
  if (error == EINPROGRESS) {
    pollfd done{fd, POLLOUT, 0};
    socklen_t size = sizeof error;
    if (poll(&done, 1, connect_ms) <= 0)
      error = ETIMEDOUT;
    else if (getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) != 0)
      error = errno;
  }
  const int yes = 1;  // a command waits for no other
  if (error == 0 && setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes) != 0) error = errno;
  if (error == 0) return fd;
  close(fd);
  return -error;
}

}  // namespace

const char* resolve(std::string host, const std::string& service, PortAddress& address) {
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = SOCK_STREAM;
  const int error = getaddrinfo(host.c_str(), service.c_str(), &wanted, &found);
  if (error != 0) return gai_strerror(error);
  std::memcpy(&address.host, found->ai_addr, found->ai_addrlen);
  address.host_size = found->ai_addrlen;
  freeaddrinfo(found);
  return nullptr;
}

PortAddress port_address(const std::string& text, int baud) {
  PortAddress address;
  address.text = text;
  address.baud = baud;
  address.tcp = text.starts_with(kTcp);
  if (!address.tcp) {
    if (text.size() >= sizeof address.device)
      throw Failure(ExitCode::kBadInput, "robot port " + text + ": the name is too long");
    std::memcpy(address.device, text.c_str(), text.size() + 1);
    return address;
  }
  const std::size_t colon = text.rfind(':');
  const std::string host = text.substr(kTcp.size(), colon < kTcp.size() ? 0 : colon - kTcp.size());
  const std::string service = text.substr(colon + 1);
  if (host.empty() || service.empty() || service.find_first_not_of("0123456789") != std::string::npos)
    throw Failure(ExitCode::kBadInput, "robot port " + text + ": not tcp:HOST:PORT, such as tcp:laptop:7170");
  if (const char* error = resolve(host, service, address); error != nullptr)
    throw Failure(ExitCode::kDeviceFault,
                  "robot port " + text + ": " + error + "; check the name of the computer on the robot");
  return address;
}

int open_port(const PortAddress& address, int connect_ms) {
  return address.tcp ? open_connection(address, connect_ms) : open_device(address);
}

// The modem lines stay as they are when the port is closed: RTS is the robot's BRC pin.
int set_line(int fd, int baud) {
  termios mode{};
  if (tcgetattr(fd, &mode) != 0) return errno;
  cfmakeraw(&mode);
  mode.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | CRTSCTS | HUPCL);
  mode.c_cflag |= CLOCAL | CREAD | CS8;
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  cfsetspeed(&mode, speed_of(baud));
  return tcsetattr(fd, TCSANOW, &mode) == 0 ? 0 : errno;
}

}  // namespace st
