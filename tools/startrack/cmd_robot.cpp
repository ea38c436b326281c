// startrack robot: what a Create tells and has besides wheels. It stands meanwhile.
#include <poll.h>

#include <cstdio>
#include <memory>

#include "hal/create/accessory.hpp"
#include "hal/create/standing_visit.hpp"
#include "hal/error.hpp"
#include "hal/system/stop_signal.hpp"
#include "tools/startrack/commands.hpp"
#include "tools/startrack/robot_options.hpp"

namespace st {
namespace {

struct Arguments {
  RobotOptions robot;
  std::vector<std::string> lines;
  double seconds = 2;
};

// A line for every sensor: its packet, name, value and unit.
void print_sensors(StandingVisit& robot) {
  const SensorState state = robot.all_sensors();
  for (int id = oi::kFirstPacket; id <= oi::kLastPacket; ++id) {
    const oi::PacketInfo* info = oi::packet_info(robot.model(), id);
    if (info == nullptr || !state.has(id)) continue;
    const oi::Sends sends = robot.model() == RobotModel::kCreate1 ? info->create1 : info->create2;
    if (sends == oi::Sends::kYes)
      std::printf("%2d  %-26s %6d  %s\n", id, info->name, state.value(id), info->unit);
  }
}

int run(const Arguments& arguments) {
  watch_stop_signals();
  StandingVisit robot(arguments.robot);
  // All of them are understood before the first is sent.
  std::vector<oi::Command> commands;
  for (const std::string& line : arguments.lines) commands.push_back(accessory_command(robot.model(), line));
  print_sensors(robot);
  std::fflush(stdout);
  for (const oi::Command& command : commands) robot.send(command);
  pollfd interrupted{stop_signal_fd(), POLLIN, 0};
  if (!commands.empty()) poll(&interrupted, 1, static_cast<int>(arguments.seconds * 1000));
  return static_cast<int>(stop_signal() != 0 ? ExitCode::kInterrupted : ExitCode::kDone);
}

}  // namespace

void add_robot(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("robot", "a standing robot's sensors, lights, songs and outputs");
  command->footer(
      "Prints every sensor with its unit, then does what the words say, in their order. The wheels stand "
      "still.\n" +
      accessory_help() +
      "Examples:\n"
      "  startrack robot --robot /dev/ttyUSB0\n"
      "  startrack robot --robot /dev/ttyUSB0 \"leds 2 128 255\" \"song 0 60 16 64 16 67 32\" \"play 0\"");
  command->add_option("--robot", arguments->robot.port, "a serial device, or tcp:HOST:PORT")
      ->required()
      ->type_name("PORT");
  command->add_option("--model", arguments->robot.model, "create1 or create2; found out when left out")
      ->transform(robot_models())
      ->type_name("");
  command->add_option("--seconds", arguments->seconds, "how long lights and outputs stay on")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_option("words", arguments->lines, "what to do, each in quotes");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace st
