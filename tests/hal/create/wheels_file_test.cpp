#include "hal/create/wheels_file.hpp"

#include <CppUTest/TestHarness.h>

#include "hal/error.hpp"
#include "hal/recording/robot_log.hpp"

using namespace st;

namespace {

std::string refusal_of(const std::string& text) {
  try {
    parse_wheels_toml(text, "robot.toml");
  } catch (const Failure& failure) {
    return failure.what();
  }
  return {};
}

}  // namespace

TEST_GROUP(WheelsFile){};

TEST(WheelsFile, ReadsBackWhatItWrites) {
  const MeasuredRobot measured{{0.2391, 0.0727, 508.8, 1.013}, 0.0325};
  const MeasuredRobot read = parse_wheels_toml(format_wheels_toml(measured), "robot.toml");
  DOUBLES_EQUAL(0.2391, read.wheels.wheel_base_m, 1e-9);
  DOUBLES_EQUAL(0.0727, read.wheels.wheel_diameter_m, 1e-9);
  DOUBLES_EQUAL(508.8, read.wheels.counts_per_turn, 1e-9);
  DOUBLES_EQUAL(1.013, read.wheels.right_to_left, 1e-9);
  DOUBLES_EQUAL(0.0325, read.camera_lag_s, 1e-9);
}

TEST(WheelsFile, WhatIsNotMeasuredStaysTheModels) {
  const MeasuredRobot read = parse_wheels_toml("wheel_base_m = 0.24\n", "robot.toml");
  DOUBLES_EQUAL(0.24, read.wheels.wheel_base_m, 0);
  DOUBLES_EQUAL(0, read.wheels.wheel_diameter_m, 0);
  DOUBLES_EQUAL(0, read.wheels.right_to_left, 0);
}

TEST(WheelsFile, RefusesWithTheLine) {
  STRCMP_CONTAINS("robot.toml:2: unknown key 'wheelbase'", refusal_of("\nwheelbase = 0.2\n").c_str());
  STRCMP_CONTAINS("robot.toml:1: wheel_base_m must be a number from 0.1 to 0.5",
                  refusal_of("wheel_base_m = 235\n").c_str());
  STRCMP_CONTAINS("robot.toml:1: wheel_diameter_m", refusal_of("wheel_diameter_m = \"72 mm\"\n").c_str());
  STRCMP_CONTAINS("robot.toml:1:", refusal_of("wheel_base_m = = 1\n").c_str());
}

// A recording's log carries the wheels by which it has to be read.
TEST(WheelsFile, TheLogKnowsOfUnequalWheels) {
  std::string line = robot_log_wheels_line({0.2391, 0.0727, 508.8, 1.013});
  line.pop_back();  // its end
  const auto wheels = parse_robot_log_wheels(line);
  CHECK(wheels.has_value());
  DOUBLES_EQUAL(1.013, wheels->right_to_left, 1e-9);
  DOUBLES_EQUAL(1, parse_robot_log_wheels("# wheels 0.235 0.072 508.8")->right_to_left, 0);
  CHECK_FALSE(parse_robot_log_wheels("# wheels 0.235 0.072 508.8 9").has_value());
}
