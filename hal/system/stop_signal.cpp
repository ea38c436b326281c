#include "hal/system/stop_signal.hpp"

#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>

namespace st {
namespace {

std::atomic<int> g_first{0};
std::atomic<bool> g_again{false};
std::atomic<int> g_event{-1};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "used in a handler");

void note(int signal_number) {
  const int kept = errno;
  int none = 0;
  if (!g_first.compare_exchange_strong(none, signal_number)) {
    if (signal_number == SIGINT) g_again.store(true);
  } else {
    const std::uint64_t one = 1;
    const ssize_t written = write(g_event.load(), &one, sizeof one);
    static_cast<void>(written);  // nobody to tell from inside a handler; the flags stand
  }
  errno = kept;
}

}  // namespace

void watch_stop_signals() {
  if (g_event.load() < 0) g_event.store(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  struct sigaction action {};
  action.sa_handler = note;
  sigemptyset(&action.sa_mask);
  for (int signal_number : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal_number, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);
}

int stop_signal() { return g_first.load(); }
bool mesh_unwanted() { return g_again.load(); }
int stop_signal_fd() { return g_event.load(); }

void forget_stop_signals() {
  std::uint64_t count = 0;
  const ssize_t got = read(g_event.load(), &count, sizeof count);
  static_cast<void>(got);  // nothing there when no signal came
  g_first.store(0);
  g_again.store(false);
}

}  // namespace st
