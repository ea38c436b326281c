// The options that every command with a robot has.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "hal/create/safety_rules.hpp"

namespace st {

// For an option that names a model: ->transform(robot_models())->type_name("").
CLI::Validator robot_models();

// --robot, the wheels' measured sizes, --on-bump.
void add_drive_options(CLI::App& command, RobotOptions& robot, std::string& on_bump);
Reaction reaction_on_bump(const std::string& word);

}  // namespace st
