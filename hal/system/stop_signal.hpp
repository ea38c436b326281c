// Ctrl-C, `kill` and a closed terminal: the handler only notes them, and the program stops the robot and
// finishes its files in its own time.
#pragma once

namespace st {

// SIGINT, SIGTERM and SIGHUP are noted from now on, and SIGPIPE is ignored: a reader that goes away shows as
// an error of that write. Blocking calls return EINTR. Call it once at start, before threads and children.
void watch_stop_signals();

int stop_signal();     // the first one that came, or 0
bool mesh_unwanted();  // Ctrl-C once more after that: the user does not want to wait for the mesh

// Becomes readable with the first signal and stays so; for poll(). -1 before watch_stop_signals().
int stop_signal_fd();

// As if no signal had come yet.
void forget_stop_signals();

}  // namespace st
