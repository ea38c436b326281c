// The safety rules: what makes the robot stop, when, and what becomes of the run. One table, in which every
// limit has its only place; the guard, the driver and the supervisor take theirs from here.
#pragma once

#include <cstdint>
#include <span>

#include "hal/create/drive_base.hpp"

namespace st {

inline constexpr int kGuardPatience_ms = 250;  // without a drive command
inline constexpr int kGuardLinger_ms = 60000;  // for a port that is gone, once the program has ended
inline constexpr int kSilent_ms = 150;         // ten slots of the stream
inline constexpr int kStaleFrame_ms = 200;
inline constexpr double kBlindTime_s = 2.0, kBlindDistance_m = 0.5;            // once it has been seen
inline constexpr double kUnseenTime_s = 5.0, kUnseenDistance_m = 1.0;          // from its first motion on
inline constexpr int kEmpty_mv = 12000, kEmpty_percent = 5, kEmpty_ms = 1000;  // twelve cells at 1.0 V

// kEnd: stops, and the run ends with code 3. kHold: stands until the cause is gone, then goes on with the
// path. kInterrupted: stops, the files are completed, code 130. kGone: the program is no more, and the guard
// has seen to the robot.
enum class Reaction : std::uint8_t { kNone, kEnd, kHold, kInterrupted, kGone };
const char* name_of(Reaction reaction);

struct SafetyRow {
  const char* name;
  const char* trigger;
  const char* limit;
  Reaction reaction;
  int stands_within_ms;  // from the trigger until both wheels stand; of that, 111 ms brake from 0.2 m/s
  RobotFault fault;      // by which the driver or the supervisor tells; kNone: the guard's, or the program's
  const char* what_to_do;
};

std::span<const SafetyRow> safety_rules();
const SafetyRow& rule_of(RobotFault fault);  // not of kNone

}  // namespace st
