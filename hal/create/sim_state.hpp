// Where the simulated robot truly is: a memory-mapped ring that create-sim writes and the simulated Kinect
// and the tests read. One writer; a reader that finds an entry overwritten tries again.
#pragma once

#include <atomic>
#include <cstdint>

namespace st {

struct SimStateEntry {
  std::int64_t monotonic_ns = 0;
  double x_m = 0, y_m = 0,
         yaw_rad = 0;  // world frame of the simulated room: the robot starts at the origin, yaw 0
  double left_mps = 0, right_mps = 0;                        // true wheel rim speeds, slip not included
  double v_mps = 0, w_rps = 0;                               // true body speeds, slip included
  std::int32_t wanted_left_mmps = 0, wanted_right_mmps = 0;  // what it was last told
  std::int32_t mode = 0;                                     // as packet 35 counts it
  std::uint32_t conditions = 0;                              // bits of SimCondition
};

enum SimCondition : std::uint32_t {
  kSimAsleep = 1,
  kSimInScriptWait = 2,
  kSimOnCharger = 4,
  kSimPulled = 8  // its pseudo-terminal is away
};

struct SimStateRing {
  static constexpr std::uint32_t kMagic = 0x53545352;  // "STSR"
  static constexpr std::uint64_t kEntries = 1024;      // at 1 kHz: the last second

  std::uint32_t magic = kMagic;
  static constexpr std::uint32_t kVersion = 2;
  std::uint32_t version = kVersion;
  std::atomic<std::uint64_t> written{0};  // entries ever written; entry i stands in slot i % kEntries
  SimStateEntry entries[kEntries];
};

}  // namespace st
