// A counting semaphore: the one thing a consumer waits on for its next frame. POSIX, since
// std::counting_semaphore of GCC 12 polls when given a timeout.
#pragma once

#include <semaphore.h>

#include <cerrno>
#include <cstdint>
#include <ctime>

namespace st {

class Semaphore {
 public:
  explicit Semaphore(unsigned count) { sem_init(&sem_, 0, count); }
  ~Semaphore() { sem_destroy(&sem_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  void post() { sem_post(&sem_); }
  void wait() {
    while (sem_wait(&sem_) != 0 && errno == EINTR) {
    }
  }
  bool try_wait() { return sem_trywait(&sem_) == 0; }

  // False when `timeout_ms` passed first.
  bool wait_for(int timeout_ms) {
    if (try_wait()) return true;
    timespec until{};
    clock_gettime(CLOCK_MONOTONIC, &until);
    const std::int64_t ns = until.tv_nsec + static_cast<std::int64_t>(timeout_ms) * 1'000'000;
    until.tv_sec += ns / 1'000'000'000;
    until.tv_nsec = ns % 1'000'000'000;
    int rc;
    do rc = sem_clockwait(&sem_, CLOCK_MONOTONIC, &until);
    while (rc != 0 && errno == EINTR);
    return rc == 0;
  }

 private:
  sem_t sem_;
};

}  // namespace st
