// What the compute thread asks of the scheduler and the CPU. Each call acts on the calling thread and reports
// what it came to as a line for the start-up print.
#pragma once

#include "hal/system/setup_step.hpp"

namespace st {

inline constexpr const char* kLoopThreadName = "st-loop";

// Above the desktop, below the USB event thread (60) and the serial guard (70). Threads started later do not
// inherit it.
inline constexpr int kLoopPriority = 50;
SetupStep use_realtime_priority(int priority);

// Keeps the thread on one CPU.
SetupStep pin_to_cpu(int cpu);

// Denormal numbers as zero, read and written: they cost a hundred cycles each and carry nothing here. Also
// keeps a result from depending on how the caller had set the mode.
SetupStep flush_denormals();

// At most 15 letters; what /proc/PID/task/*/comm shows.
void name_this_thread(const char* name);

}  // namespace st
