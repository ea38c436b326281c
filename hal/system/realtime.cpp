#include "hal/system/realtime.hpp"

#include <immintrin.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>

namespace st {
namespace {

constexpr const char* kChooseCpu = "choose one of those that `taskset -pc $$` lists";

}  // namespace

SetupStep use_realtime_priority(int priority) {
  sched_param wanted{};
  wanted.sched_priority = priority;
  const std::string what = "SCHED_FIFO priority " + std::to_string(priority);
  if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &wanted) == 0)
    return {true, "scheduler: " + what};
  const int error = errno;
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  return {false,
          "scheduler: " + what + " refused (" + std::strerror(error) + ", rtprio limit " +
              std::to_string(limit.rlim_cur) +
              "), other programs can delay frames and wall times include that",
          kInstallLimits};
}

SetupStep pin_to_cpu(int cpu) {
  const std::string what = "affinity: CPU " + std::to_string(cpu);
  if (cpu < 0 || cpu >= CPU_SETSIZE) return {false, what + " does not exist", kChooseCpu};
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  if (sched_setaffinity(0, sizeof set, &set) == 0) return {true, what};
  return {false, what + " refused (" + std::strerror(errno) + ")", kChooseCpu};
}

SetupStep flush_denormals() {
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
  _mm_setcsr(_mm_getcsr() | kFlushToZero | kDenormalsAreZero);
  return {true, "arithmetic: denormals are zero"};
}

void name_this_thread(const char* name) { pthread_setname_np(pthread_self(), name); }

}  // namespace st
