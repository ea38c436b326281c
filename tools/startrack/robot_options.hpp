// The options that every command with a robot has.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "hal/create/safety_rules.hpp"

namespace st {

// For an option that names a model: ->transform(robot_models())->type_name("").
CLI::Validator robot_models();

// --robot, the wheels' measured sizes, --on-bump. `camera_lag_s`: where the lag of a --wheels FILE goes;
// null: nowhere, since there is no camera.
void add_drive_options(CLI::App& command, RobotOptions& robot, std::string& on_bump, double* camera_lag_s);
Reaction reaction_on_bump(const std::string& word);

}  // namespace st
