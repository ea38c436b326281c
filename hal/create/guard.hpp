// The guard: a small child process that alone holds the robot's port. The Create has no watchdog of its own
// and goes on driving when nobody speaks to it, so the guard sends stop when the program's drive commands
// cease, whatever became of the program: killed, crashed, stopped by Ctrl-Z, terminal closed, loop stalled.
//
// A port that goes away, as when the cable is pulled, is opened again as soon as it is back, and the first
// thing that the robot then hears is stop; for a while even when the program has ended meanwhile, since it is
// then that a robot may be driving on with nobody to stop it.
//
// Commands by which the robot would drive on its own (cleaning, demos, docking), stop listening (waits,
// scripts, another baud rate) or heed no edge (Full mode) do not pass.
//
// The program and the guard speak over one socket that keeps messages whole. To the guard: one Open Interface
// command per message; those that drive are the heartbeats. From the guard: a byte that says which way, then
// the bytes.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>

#include "hal/create/oi.hpp"
#include "hal/create/port_address.hpp"
#include "hal/create/safety_rules.hpp"

namespace st {

struct GuardOrders {
  int silence_ms = kGuardPatience_ms;  // drive commands cease for so long: stop
  int linger_ms = kGuardLinger_ms;     // the program has ended and the port is gone: wait so long for it
  oi::Command stop;                    // wheels still; also repeated while the silence lasts
  oi::Command farewell;                // at the end, after stop: back to a mode in which the robot charges
};

GuardOrders orders_for(RobotModel model);

enum GuardMessage : std::uint8_t {
  kGuardReady = 'g',
  kGuardReceived = 'r',
  kGuardSent = 't',
  kGuardPortGone = 'x',
  kGuardPortBack = 'b'
};
inline constexpr std::size_t kGuardMessageBytes = 1 + 512;

struct Guard {
  pid_t pid = -1;
  int link = -1;  // the program's end of the socket, non-blocking; closing or shutting it down ends the guard
};

// Forks the guard, which inherits `port` (non-blocking, raw) and, when not -1, `keep_open`, and closes
// everything else. `address`: how to open the port again. Call it while the process has one thread that
// matters and little memory. Throws Failure when it cannot fork.
Guard start_guard(int port, const PortAddress& address, const GuardOrders& orders, int keep_open = -1);

}  // namespace st
