#include "hal/create/sim/world_script.hpp"

#include <charconv>
#include <cstring>

#include "hal/error.hpp"

namespace st::sim {
namespace {

constexpr struct {
  const char* name;
  WorldEventKind kind;
} kEvents[] = {{"bump", WorldEventKind::kBump},
               {"cliff", WorldEventKind::kCliff},
               {"wheel-drop", WorldEventKind::kWheelDrop},
               {"charger", WorldEventKind::kCharger},
               {"unplug", WorldEventKind::kUnplug},
               {"low-battery", WorldEventKind::kLowBattery},
               {"reset", WorldEventKind::kReset},
               {"text", WorldEventKind::kText},
               {"clear", WorldEventKind::kClear}};

}  // namespace

WorldEvent parse_world_event(const std::string& text) {
  WorldEvent event;
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const char* end = text.data() + colon;
    const auto [stop, error] = std::from_chars(text.data(), end, event.at_s);
    if (error == std::errc() && stop == end && event.at_s >= 0)
      for (const auto& row : kEvents)
        if (text.substr(colon + 1) == row.name) {
          event.kind = row.kind;
          return event;
        }
  }
  std::string names;
  for (const auto& row : kEvents) names += std::string(names.empty() ? "" : ", ") + row.name;
  throw Failure(ExitCode::kBadInput, "--at " + text + ": not SECONDS:EVENT; events are " + names);
}

void apply(WorldEventKind kind, CreateEngine& engine) {
  CreateWorld& world = engine.world();
  switch (kind) {
    case WorldEventKind::kBump:
      world.bump_left = world.bump_right = true;
      return;
    case WorldEventKind::kCliff:
      world.cliffs = 2;
      return;
    case WorldEventKind::kWheelDrop:
      world.wheel_drops = 0x0c;
      return;
    case WorldEventKind::kCharger:
      world.on_charger = true;
      return;
    case WorldEventKind::kUnplug:
      world.unplugged = true;
      return;
    case WorldEventKind::kLowBattery:
      world.battery_mv = 11500;
      world.charge_mah = 60;
      return;
    case WorldEventKind::kReset: {
      const std::uint8_t reset = oi::kReset;
      engine.receive({&reset, 1});
      return;
    }
    case WorldEventKind::kText:
      engine.say("\r\nbat:   min 3  sec 10  mV 15613  mA -212  deg-C 24\r\n");
      return;
    case WorldEventKind::kClear:
      world = CreateWorld{};
      return;
  }
}

}  // namespace st::sim
