#include "hal/system/key_stop.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>

#include "hal/system/stop_signal.hpp"

namespace st {
namespace {

constexpr int kCountdown_s = 3;

bool terminal_is_ours() { return isatty(STDIN_FILENO) != 0 && tcgetpgrp(STDIN_FILENO) == getpgrp(); }

void watch_for_key(int end) {
  pollfd events[2] = {{STDIN_FILENO, POLLIN, 0}, {end, POLLIN, 0}};
  while (poll(events, 2, -1) < 0) {
  }
  char key;
  if (events[1].revents == 0 && read(STDIN_FILENO, &key, 1) == 1) kill(getpid(), SIGINT);
}

}  // namespace

bool arm_at_terminal() {
  if (!terminal_is_ours()) return true;
  std::fprintf(stderr,
               "The robot is about to drive. Clear its way, then press Enter to arm it; Ctrl-C leaves. ");
  pollfd events[2] = {{STDIN_FILENO, POLLIN, 0}, {stop_signal_fd(), POLLIN, 0}};
  while (stop_signal() == 0 && poll(events, 2, -1) < 0) {
  }
  char key = 0;
  if (stop_signal() != 0 || read(STDIN_FILENO, &key, 1) != 1 || key != '\n') return false;
  for (int left_s = kCountdown_s; left_s > 0 && stop_signal() == 0; --left_s) {
    std::fprintf(stderr, "\a%d... ", left_s);
    poll(events + 1, 1, 1000);
  }
  std::fprintf(stderr, "any key stops it\n");
  return stop_signal() == 0;
}

KeyStop::KeyStop() {
  if (!terminal_is_ours() || tcgetattr(STDIN_FILENO, &before_) != 0) return;
  end_ = eventfd(0, EFD_CLOEXEC);
  if (end_ < 0) return;
  termios keys = before_;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // signals stay: Ctrl-C and Ctrl-Z are the shell's
  tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  // Signals are for the program's own threads.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  watcher_ = std::thread(watch_for_key, end_);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

KeyStop::~KeyStop() {
  if (!watcher_.joinable()) return;
  const std::uint64_t one = 1;
  const ssize_t written = write(end_, &one, sizeof one);
  static_cast<void>(written);
  watcher_.join();
  close(end_);
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

}  // namespace st
