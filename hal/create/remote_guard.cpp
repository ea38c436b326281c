#include "hal/create/remote_guard.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>

#include "hal/create/handshake.hpp"
#include "hal/create/listener.hpp"
#include "hal/create/robot_port.hpp"
#include "hal/create/sim_child.hpp"
#include "hal/error.hpp"
#include "hal/system/stop_signal.hpp"

namespace st {
namespace {

constexpr int kGuardEnd_ms = 1000;

}  // namespace

RemoteGuard::RemoteGuard(const RobotOptions& robot, const std::string& address)
    : listener_(listen_at("--listen", address)) {
  try {
    RobotLogWriter no_log{std::string()};
    RobotPort port(robot.port);
    model_ = meet_robot(port, robot.model, no_log).model;
    commands_ = oi::CommandReader(model_);
    guard_ = start_guard(port.fd(), port.address(), orders_for(model_));
  } catch (...) {
    close(listener_);
    throw;
  }
}

RemoteGuard::~RemoteGuard() {
  if (program_ >= 0) close(program_);
  close(listener_);
  close(guard_.link);
  wait_for_child(guard_.pid, kGuardEnd_ms);
}

int RemoteGuard::port() const { return bound_port(listener_); }

bool RemoteGuard::serve() {
  for (;;) {
    pollfd events[4] = {{stop_signal_fd(), POLLIN, 0},
                        {listener_, POLLIN, 0},
                        {guard_.link, POLLIN, 0},
                        {program_, POLLIN, 0}};
    if (poll(events, 4, -1) < 0 && errno != EINTR) return false;
    if (stop_signal() != 0) return true;
    if (events[1].revents != 0) accept_program();
    if (events[2].revents != 0 && !from_robot()) return false;
    if (program_ >= 0 && events[3].revents != 0) from_program();
  }
}

// One at a time: the robot obeys nobody else as long as somebody drives it.
void RemoteGuard::accept_program() {
  const int fd = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (fd < 0) return;
  if (program_ >= 0) {
    close(fd);
    return;
  }
  const int yes = 1;  // a frame waits for no other
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  program_ = fd;
}

void RemoteGuard::part_from_program() {
  close(program_);
  program_ = -1;
  commands_.forget();  // the torn rest of its last command must not eat the stop
  for (const oi::Command& command : {oi::halt(), oi::pause_stream(false), oi::simple(oi::kStart)})
    send(guard_.link, command.bytes, command.size, MSG_DONTWAIT | MSG_NOSIGNAL);
}

// Whole commands only, so that a stop of the guard's own always stands between two of them.
void RemoteGuard::from_program() {
  std::uint8_t bytes[1024];
  const ssize_t n = recv(program_, bytes, sizeof bytes, MSG_DONTWAIT);
  if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) {
    part_from_program();
    return;
  }
  for (ssize_t i = 0; i < n; ++i) {
    if (!commands_.push(bytes[i])) continue;
    const auto command = commands_.command();
    if (command.size() <= oi::Command::kCapacity)
      send(guard_.link, command.data(), command.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  }
}

// False: the guard process is gone. What the program is too slow to take is lost, as on a cable.
bool RemoteGuard::from_robot() {
  std::uint8_t message[kGuardMessageBytes];
  const ssize_t n = recv(guard_.link, message, sizeof message, MSG_DONTWAIT);
  if (n <= 0) return n < 0 && (errno == EAGAIN || errno == EINTR);
  if (message[0] == kGuardReceived && program_ >= 0)
    send(program_, message + 1, static_cast<std::size_t>(n) - 1, MSG_DONTWAIT | MSG_NOSIGNAL);
  return true;
}

}  // namespace st
