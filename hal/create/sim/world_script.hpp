// What happens to a simulated robot, and when: `2.5:cliff`. For tests and for lessons about what a program
// must withstand.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/create/sim/create_engine.hpp"

namespace st::sim {

// Pull takes the pseudo-terminal away while the robot goes on, as when the cable is pulled; Replug brings a
// new one under the same link. The others are the engine's.
enum class WorldEventKind {
  kBump,
  kBumpLeft,
  kBumpRight,
  kCliff,
  kWheelDrop,
  kCharger,
  kChargingFault,
  kDock,
  kWall,
  kVirtualWall,
  kBlocked,
  kButton,
  kUnplug,
  kMute,
  kLowBattery,
  kReset,
  kText,
  kSleep,
  kWake,
  kPull,
  kReplug,
  kClear
};

struct WorldEvent {
  double at_s = 0;
  WorldEventKind kind = WorldEventKind::kClear;
};

// `SECONDS:EVENT`. Throws Failure (kBadInput) with what is allowed.
WorldEvent parse_world_event(const std::string& text);
std::optional<WorldEventKind> world_event_named(std::string_view name);
std::string world_event_names();  // with commas
void apply(WorldEventKind kind, CreateEngine& engine);

}  // namespace st::sim
