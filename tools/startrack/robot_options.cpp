#include "tools/startrack/robot_options.hpp"

namespace st {

CLI::Validator robot_models() {
  const auto to_number = [](std::string& word) -> std::string {
    if (word != "create1" && word != "create2") return word + " is no model; there are create1 and create2";
    const RobotModel model = word == "create1" ? RobotModel::kCreate1 : RobotModel::kCreate2;
    word = std::to_string(static_cast<int>(model));
    return {};
  };
  return {to_number, "create1|create2"};
}

void add_drive_options(CLI::App& command, RobotOptions& robot, std::string& on_bump) {
  command
      .add_option(
          "--robot", robot.port,
          "a serial device such as /dev/ttyUSB0, tcp:HOST:PORT, or sim[:SWITCH=VALUE,...] with switches of "
          "create-sim")
      ->type_name("PORT");
  command
      .add_option("--wheel-base", robot.wheels.wheel_base_m, "measured, in metres, instead of the model's")
      ->check(CLI::Range(0.1, 0.5));
  command.add_option("--wheel-diameter", robot.wheels.wheel_diameter_m, "measured, in metres")
      ->check(CLI::Range(0.03, 0.2));
  command
      .add_option("--wheel-counts", robot.wheels.counts_per_turn,
                  "encoder counts of a wheel's turn (Create 2)")
      ->check(CLI::Range(50.0, 5000.0));
  command
      .add_option("--on-bump", on_bump,
                  "when it runs into something: end the drive, hold until it is free, or ignore it")
      ->check(CLI::IsMember({"end", "hold", "ignore"}))
      ->capture_default_str();
}

Reaction reaction_on_bump(const std::string& word) {
  return word == "hold" ? Reaction::kHold : word == "ignore" ? Reaction::kNone : Reaction::kEnd;
}

}  // namespace st
