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
               {"bump-left", WorldEventKind::kBumpLeft},
               {"bump-right", WorldEventKind::kBumpRight},
               {"cliff", WorldEventKind::kCliff},
               {"wheel-drop", WorldEventKind::kWheelDrop},
               {"charger", WorldEventKind::kCharger},
               {"charging-fault", WorldEventKind::kChargingFault},
               {"dock", WorldEventKind::kDock},
               {"wall", WorldEventKind::kWall},
               {"virtual-wall", WorldEventKind::kVirtualWall},
               {"blocked", WorldEventKind::kBlocked},
               {"button", WorldEventKind::kButton},
               {"unplug", WorldEventKind::kUnplug},
               {"mute", WorldEventKind::kMute},
               {"low-battery", WorldEventKind::kLowBattery},
               {"reset", WorldEventKind::kReset},
               {"text", WorldEventKind::kText},
               {"sleep", WorldEventKind::kSleep},
               {"wake", WorldEventKind::kWake},
               {"pull", WorldEventKind::kPull},
               {"replug", WorldEventKind::kReplug},
               {"clear", WorldEventKind::kClear}};

}  // namespace

std::optional<WorldEventKind> world_event_named(std::string_view name) {
  for (const auto& row : kEvents)
    if (name == row.name) return row.kind;
  return std::nullopt;
}

std::string world_event_names() {
  std::string names;
  for (const auto& row : kEvents) names += std::string(names.empty() ? "" : ", ") + row.name;
  return names;
}

WorldEvent parse_world_event(const std::string& text) {
  WorldEvent event;
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const char* end = text.data() + colon;
    const auto [stop, error] = std::from_chars(text.data(), end, event.at_s);
    const std::optional<WorldEventKind> kind = world_event_named(text.substr(colon + 1));
    if (error == std::errc() && stop == end && event.at_s >= 0 && kind) {
      event.kind = *kind;
      return event;
    }
  }
  throw Failure(ExitCode::kBadInput,
                "--at " + text + ": not SECONDS:EVENT; events are " + world_event_names());
}

void apply(WorldEventKind kind, CreateEngine& engine) {
  CreateWorld& world = engine.world();
  switch (kind) {
    case WorldEventKind::kBump:
      world.bump_left = world.bump_right = true;
      return;
    case WorldEventKind::kBumpLeft:
      world.bump_left = true;
      return;
    case WorldEventKind::kBumpRight:
      world.bump_right = true;
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
    case WorldEventKind::kChargingFault:
      world.on_charger = true;
      world.charging_state = 6;
      return;
    case WorldEventKind::kDock:
      world.dock_near = true;
      return;
    case WorldEventKind::kWall:
      world.wall = true;
      return;
    case WorldEventKind::kVirtualWall:
      world.virtual_wall = true;
      return;
    case WorldEventKind::kBlocked:
      world.blocked = true;
      return;
    case WorldEventKind::kButton:
      world.buttons = 1;  // Play or Clean
      return;
    case WorldEventKind::kMute:
      world.mute = true;
      return;
    case WorldEventKind::kSleep:
      engine.fall_asleep();
      return;
    case WorldEventKind::kWake:
      engine.press_power();
      return;
    case WorldEventKind::kPull:
    case WorldEventKind::kReplug:
      return;  // of the pseudo-terminal, not of the robot
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
      engine.say(kBatteryText);
      return;
    case WorldEventKind::kClear:
      world = CreateWorld{};
      return;
  }
}

}  // namespace st::sim
