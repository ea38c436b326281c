// What a Create has besides wheels, by words: lights, songs, digits, outputs. `leds 2 0 255` is the command
// that it stands for. One table, for both models.
#pragma once

#include <string>
#include <string_view>

#include "hal/create/oi.hpp"

namespace st {

// The command for one line of words. Throws Failure (kBadInput) with what is allowed.
oi::Command accessory_command(RobotModel model, std::string_view line);

// A line for every word, with its arguments and what it does.
std::string accessory_help();

}  // namespace st
