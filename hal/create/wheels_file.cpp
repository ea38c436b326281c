#include "hal/create/wheels_file.hpp"

#include <toml++/toml.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "hal/error.hpp"

namespace st {
namespace {

struct Key {
  const char* name;
  double least, most;
  double& (*value)(MeasuredRobot&);
};
constexpr Key kKeys[] = {
    {"wheel_base_m", 0.1, 0.5, [](MeasuredRobot& r) -> double& { return r.wheels.wheel_base_m; }},
    {"wheel_diameter_m", 0.03, 0.2, [](MeasuredRobot& r) -> double& { return r.wheels.wheel_diameter_m; }},
    {"counts_per_turn", 50, 5000, [](MeasuredRobot& r) -> double& { return r.wheels.counts_per_turn; }},
    {"right_to_left", 0.8, 1.25, [](MeasuredRobot& r) -> double& { return r.wheels.right_to_left; }},
    {"camera_lag_s", -0.1, 0.5, [](MeasuredRobot& r) -> double& { return r.camera_lag_s; }},
};

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value);
  return text;
}

}  // namespace

MeasuredRobot parse_wheels_toml(std::string_view text, const std::string& name) {
  MeasuredRobot robot;
  toml::table table;
  try {
    table = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw Failure(ExitCode::kBadInput, name + ":" + std::to_string(error.source().begin.line) + ": " +
                                           std::string(error.description()));
  }
  for (const auto& [key, node] : table) {
    const std::string where = name + ":" + std::to_string(key.source().begin.line) + ": ";
    const Key* known = nullptr;
    for (const Key& k : kKeys)
      if (key.str() == k.name) known = &k;
    if (known == nullptr) {
      std::string trouble = where;
      trouble.append("unknown key '").append(key.str()).append("'; known here:");
      for (const Key& k : kKeys) trouble.append(" ").append(k.name);
      throw Failure(ExitCode::kBadInput, trouble);
    }
    const std::optional<double> value = node.value<double>();
    if (!value || !(*value >= known->least && *value <= known->most))
      throw Failure(ExitCode::kBadInput, where + known->name + " must be a number from " +
                                             short_number(known->least) + " to " + short_number(known->most));
    known->value(robot) = *value;
  }
  return robot;
}

MeasuredRobot read_wheels_file(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file)
    throw Failure(ExitCode::kBadInput,
                  path + ": cannot be read; `startrack calibrate robot` makes such a file");
  return parse_wheels_toml(text.str(), path);
}

std::string format_wheels_toml(const MeasuredRobot& robot) {
  MeasuredRobot copy = robot;
  std::string text;
  for (const Key& key : kKeys)
    if (key.value(copy) != 0) text += std::string(key.name) + " = " + short_number(key.value(copy)) + "\n";
  return text;
}

}  // namespace st
