// What can go wrong while a robot drives, done to real processes and a simulated robot: one or more
// provocations for every row of the safety rules. The tests do each once, the fault campaign a thousand
// times.
#pragma once

#include <span>
#include <string>

#include "hal/create/safety_rules.hpp"

namespace st::test {

struct Outcome {
  bool drove = false;     // the robot was under way when it happened; else the rest means nothing
  double stood_ms = -1;   // from the trigger; -1: it drives on
  double way_m = 0;       // from the trigger until it stood
  int exit_code = -1000;  // of the program
  std::string why;        // it stood, where the provocation knows
};

struct Provocation {
  const char* rule;  // its row
  const char* name;
  int exit_code;  // that the program must end with; kAny: it may be gone, or still wait
  Outcome (*run)(const Provocation& what, int after_ms);
  const char* event;   // of create-sim, that does the harm
  const char* before;  // event that comes first, whose end is the trigger
  int signal;
};
inline constexpr int kAny = -1;

std::span<const Provocation> provocations();
const SafetyRow& row_named(const std::string& name);

// Drives, waits so long, does the harm, and tells when the robot stood.
inline Outcome provoke(const Provocation& what, int after_ms) { return what.run(what, after_ms); }

}  // namespace st::test
