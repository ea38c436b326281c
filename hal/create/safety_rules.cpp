#include "hal/create/safety_rules.hpp"

#include <iterator>

namespace st {
namespace {

using enum Reaction;

constexpr SafetyRow kRules[] = {
    {"cliff", "a cliff sensor sees no floor", "one frame (15 ms)", kEnd, 300, RobotFault::kCliff,
     "it stands at an edge; put it back on the floor"},
    {"wheel_drop", "a wheel hangs in the air", "one frame (15 ms)", kEnd, 300, RobotFault::kWheelDrop,
     "a wheel hangs in the air; put it back on the floor"},
    {"bump", "the bumper is pressed", "one frame (15 ms); --on-bump end, hold or ignore", kEnd, 300,
     RobotFault::kBump, "it ran into something; clear its way"},
    {"left_safe_mode", "the robot left Safe mode by itself, as on its charger", "one frame (15 ms)", kEnd,
     300, RobotFault::kLeftSafeMode, "it left Safe mode by itself; take it off the charger and start again"},
    {"low_battery", "below 12.0 V or 5 % charge", "1 s", kEnd, 1500, RobotFault::kLowBattery,
     "its battery is empty; charge it before the next drive"},
    {"silent", "no good frame from the robot", "150 ms", kEnd, 500, RobotFault::kSilent,
     "nothing comes from it; stop it by hand if it moves, then check its battery and cable"},
    {"disconnected", "the cable is pulled, at either end", "at once, when it is back", kEnd, 300,
     RobotFault::kDisconnected,
     "the port went away; the robot may drive on: stop it by hand, or plug the cable in again within a "
     "minute"},
    {"not_seen", "no object is tracked while the robot drives",
     "2 s or 0.5 m; 5 s or 1 m before the first pose", kEnd, 2400, RobotFault::kNotSeen,
     "the camera does not see the robot; keep its path within the view"},
    {"stale", "the camera has no new frame", "200 ms", kHold, 500, RobotFault::kStale,
     "the camera's frames come late; see to its cable and to the load on this computer"},
    {"stalled", "the loop gives no command; also Ctrl-Z and SIGSTOP", "250 ms", kHold, 500, RobotFault::kNone,
     "the guard has stopped it; it goes on with the program"},
    {"killed", "the program crashes, fails an assertion or is killed", "at once", kGone, 300,
     RobotFault::kNone, "the guard has stopped it"},
    {"guard_killed", "the guard process is killed", "at once", kEnd, 300, RobotFault::kDisconnected,
     "the program has stopped it; start again"},
    {"signal", "Ctrl-C, kill, or the terminal is closed", "at once (100 ms)", kInterrupted, 300,
     RobotFault::kNone, "it stands; start again"},
    {"key", "a key is pressed in the program's terminal", "at once (100 ms)", kInterrupted, 300,
     RobotFault::kNone, "it stands; start again"},
};

}  // namespace

std::span<const SafetyRow> safety_rules() { return kRules; }

const SafetyRow& rule_of(RobotFault fault) {
  for (const SafetyRow& row : kRules)
    if (row.fault == fault) return row;
  return kRules[std::size(kRules) - 1];
}

const char* name_of(RobotFault fault) { return fault == RobotFault::kNone ? "none" : rule_of(fault).name; }

const char* name_of(Reaction reaction) {
  switch (reaction) {
    case kNone:
      return "none";
    case kEnd:
      return "ends with code 3";
    case kHold:
      return "stands, then goes on";
    case kInterrupted:
      return "ends with code 130";
    case kGone:
      return "is no more";
  }
  return "unknown";
}

}  // namespace st
