#include "hal/create/guard.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hal/error.hpp"

// After the fork only system calls and the stack: no heap, no locks, nothing of the program's that another
// thread may have left half-done.
namespace st {
namespace {

constexpr int kLastWords_ms = 200;  // at most so long for the farewell to leave
constexpr int kTryAgain_ms = 50;    // how often a port that is gone is looked for
constexpr int kConnect_ms = 300;

std::int64_t now_ms() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1000 + t.tv_nsec / 1000000;
}

// Bytes on their way to the robot. Whole commands only: the robot would take the next command for the rest of
// a torn one.
class Outbox {
 public:
  void add(std::span<const std::uint8_t> command) {
    if (command.size() > sizeof bytes_ - size_) return;
    std::memcpy(bytes_ + size_, command.data(), command.size());
    size_ += command.size();
  }
  bool empty() const { return size_ == 0; }
  void forget() { size_ = 0; }
  // Writes what the port takes now, and tells the program what left. False: the port is gone.
  bool flush(int port, int link) {
    while (size_ > 0) {
      const ssize_t n = write(port, bytes_, std::min(size_, kGuardMessageBytes - 1));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return errno == EAGAIN;
      std::uint8_t message[kGuardMessageBytes];
      message[0] = kGuardSent;
      std::memcpy(message + 1, bytes_, static_cast<std::size_t>(n));
      send(link, message, static_cast<std::size_t>(n) + 1, MSG_DONTWAIT | MSG_NOSIGNAL);
      size_ -= static_cast<std::size_t>(n);
      std::memmove(bytes_, bytes_ + n, size_);
    }
    return true;
  }

 private:
  std::uint8_t bytes_[2048];
  std::size_t size_ = 0;
};

bool pass_from_robot(int port, int link) {
  std::uint8_t message[kGuardMessageBytes];
  message[0] = kGuardReceived;
  const ssize_t n = read(port, message + 1, sizeof message - 1);
  if (n < 0) return errno == EAGAIN || errno == EINTR;
  if (n == 0) return false;
  // A program that is stopped does not read; what it misses is lost, and the next good frame finds itself.
  send(link, message, static_cast<std::size_t>(n) + 1, MSG_DONTWAIT | MSG_NOSIGNAL);
  return true;
}

void tell(int link, GuardMessage what) {
  const std::uint8_t message = what;
  send(link, &message, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
}

void say_farewell(int port, int link, Outbox& out, const GuardOrders& orders) {
  out.add(orders.stop.span());
  out.add(orders.farewell.span());
  const std::int64_t end_ms = now_ms() + kLastWords_ms;
  while (out.flush(port, link) && !out.empty() && now_ms() < end_ms) {
    pollfd room{port, POLLOUT, 0};
    poll(&room, 1, 10);
  }
}

// Until the program ends, the guard is told to end, or the port goes away. False: the port is gone.
bool watch(int port, int link, int signals, const GuardOrders& orders, Outbox& out) {
  std::int64_t silent_at_ms = now_ms() + orders.silence_ms;
  for (;;) {
    const std::int64_t left_ms = silent_at_ms - now_ms();
    if (left_ms <= 0) {
      out.add(orders.stop.span());
      silent_at_ms = now_ms() + orders.silence_ms;
      continue;
    }
    if (!out.flush(port, link)) return false;
    const short port_events = static_cast<short>(out.empty() ? POLLIN : POLLIN | POLLOUT);
    pollfd events[3] = {{port, port_events, 0}, {link, POLLIN, 0}, {signals, POLLIN, 0}};
    if (poll(events, 3, static_cast<int>(left_ms)) < 0) continue;
    if (events[2].revents != 0) return true;
    if (events[1].revents != 0) {
      std::uint8_t command[oi::Command::kCapacity];
      const ssize_t n = recv(link, command, sizeof command, MSG_DONTWAIT);
      if (n == 0 || (n < 0 && errno != EAGAIN)) return true;  // the program is no more
      if (n > 0 && !oi::escapes_guard(command[0])) out.add({command, static_cast<std::size_t>(n)});
      if (n > 0 && oi::drives(command[0])) silent_at_ms = now_ms() + orders.silence_ms;
    }
    if ((events[0].revents & ~POLLOUT) != 0 && !pass_from_robot(port, link)) return false;
  }
}

// Opens the port again once it is there. -1: told to end, another program has it, or the program is no more
// and nothing came back for as long as the orders say.
int wait_for_port(int& link, int signals, const PortAddress& address, const GuardOrders& orders) {
  std::int64_t end_ms = -1, try_ms = now_ms();  // no end while the program lives
  for (;;) {
    pollfd events[2] = {{signals, POLLIN, 0}, {link, POLLIN, 0}};
    poll(events, 2, static_cast<int>(std::max<std::int64_t>(0, try_ms - now_ms())));
    if (events[0].revents != 0) return -1;
    if (events[1].revents != 0) {
      std::uint8_t unheard[oi::Command::kCapacity];
      const ssize_t n = recv(link, unheard, sizeof unheard, MSG_DONTWAIT);
      if (n == 0 || (n < 0 && errno != EAGAIN)) {
        close(link);
        link = -1;
        end_ms = now_ms() + orders.linger_ms;
      }
    }
    if (now_ms() < try_ms) continue;
    try_ms = now_ms() + kTryAgain_ms;
    const int port = open_port(address, kConnect_ms);
    if (port >= 0) return port;
    if (end_ms >= 0 && (now_ms() >= end_ms || port == -EBUSY || port == -EWOULDBLOCK)) return -1;
  }
}

void close_all_but(int a, int b, int c, int d) {
  int keep[] = {a, b, c, d};
  std::sort(std::begin(keep), std::end(keep));
  unsigned first = 3;
  for (const int fd : keep) {
    if (fd < 3) continue;
    if (static_cast<unsigned>(fd) > first) close_range(first, static_cast<unsigned>(fd) - 1, 0);
    first = static_cast<unsigned>(fd) + 1;
  }
  close_range(first, ~0U, 0);
}

[[noreturn]] void guard_main(int port, int link, int keep_open, const PortAddress& address,
                             const GuardOrders& orders) {
  setsid();  // Ctrl-C, Ctrl-Z and the closing of the terminal are not for the guard
  prctl(PR_SET_NAME, "st-guard");
  sigset_t ending;  // all are blocked since before the fork
  sigemptyset(&ending);
  for (const int number : {SIGTERM, SIGHUP, SIGINT, SIGQUIT}) sigaddset(&ending, number);
  const int signals = signalfd(-1, &ending, SFD_NONBLOCK);
  close_all_but(port, link, signals, keep_open);
  const int nothing = open("/dev/null", O_RDWR);
  for (int fd = 0; fd < 3; ++fd) dup2(nothing, fd);
  sched_param priority{};
  priority.sched_priority = 70;  // above the loop it guards; refused without permission, and then ordinary
  sched_setscheduler(0, SCHED_FIFO, &priority);
  tell(link, kGuardReady);
  Outbox out;
  while (!watch(port, link, signals, orders, out)) {
    tell(link, kGuardPortGone);
    close(port);
    port = wait_for_port(link, signals, address, orders);
    if (port < 0) _exit(0);
    out.forget();  // what was on its way is old by now
    if (link < 0) break;
    out.add(orders.stop.span());
    tell(link, kGuardPortBack);
  }
  say_farewell(port, link, out, orders);
  _exit(0);
}

}  // namespace

GuardOrders orders_for(RobotModel model) {
  GuardOrders orders;
  orders.stop = oi::halt();
  orders.farewell = oi::pause_stream(false);
  orders.farewell.add(oi::kStart);  // Passive: it can charge
  if (model == RobotModel::kCreate2)
    orders.farewell.add(oi::kStop);  // and Off; the Create 1 has no such opcode
  return orders;
}

Guard start_guard(int port, const PortAddress& address, const GuardOrders& orders, int keep_open) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
    throw Failure(ExitCode::kDeviceFault, std::string("robot guard: no socket: ") + std::strerror(errno));
  // A signal between the fork and the guard's own settings would end it, or run the program's handler in it.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t pid = fork();
  if (pid == 0) guard_main(port, ends[1], keep_open, address, orders);
  const int error = errno;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  close(ends[1]);
  std::uint8_t message = 0;
  if (pid > 0) recv(ends[0], &message, 1, 0);
  if (message != kGuardReady) {
    close(ends[0]);
    throw Failure(ExitCode::kDeviceFault,
                  std::string("robot guard: cannot start a process: ") + std::strerror(error));
  }
  return {pid, ends[0]};
}

}  // namespace st
