// A person at the terminal of a program that moves a robot: arms it, and stops it with any key.
#pragma once

#include <termios.h>

#include <thread>

namespace st {

// Where stdin is a terminal: asks for Enter, then counts down three seconds; everybody near the robot hears
// the beep and sees it coming. False: another key, a signal, or the end of the input. True at once where
// there is no terminal: a script knows what it does.
bool arm_at_terminal();

// While it lives, any key at the terminal is a Ctrl-C. Does nothing where stdin is no terminal, or is another
// job's.
class KeyStop {
 public:
  KeyStop();
  ~KeyStop();  // gives the terminal back as it was
  KeyStop(const KeyStop&) = delete;
  KeyStop& operator=(const KeyStop&) = delete;

 private:
  termios before_{};
  int end_ = -1;
  std::thread watcher_;
};

}  // namespace st
