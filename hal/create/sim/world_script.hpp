// What happens to a simulated robot, and when: `2.5:cliff`. For tests and for lessons about what a program
// must withstand.
#pragma once

#include <string>
#include <vector>

#include "hal/create/sim/create_engine.hpp"

namespace st::sim {

enum class WorldEventKind {
  kBump,
  kCliff,
  kWheelDrop,
  kCharger,
  kUnplug,
  kLowBattery,
  kReset,
  kText,
  kClear
};

struct WorldEvent {
  double at_s = 0;
  WorldEventKind kind = WorldEventKind::kClear;
};

// `SECONDS:EVENT`. Throws Failure (kBadInput) with what is allowed.
WorldEvent parse_world_event(const std::string& text);
void apply(WorldEventKind kind, CreateEngine& engine);

}  // namespace st::sim
