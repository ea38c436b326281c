#include "hal/create/wheel_log.hpp"

#include <CppUTest/TestHarness.h>

#include <filesystem>

#include "hal/create/oi.hpp"
#include "hal/error.hpp"
#include "hal/recording/robot_log.hpp"
#include "tests/support/temp_folder.hpp"

using namespace st;

namespace {

constexpr RobotGeometry kAsMeasured{0.2391, 0.0742, 508.8, 1.02};

// 508 counts, which is nearly a turn, of each wheel, driven with those wheels.
std::string a_turn(RobotModel model, const RobotGeometry* wheels) {
  std::string log = robot_log_first_line(model);
  if (wheels != nullptr) log += robot_log_wheels_line(*wheels);
  const std::uint8_t list[] = {oi::kEncoderLeft, oi::kEncoderRight};
  log += format_robot_log_line(1, false, oi::stream(list).span());
  for (int i = 0; i <= 127; ++i) {
    std::vector<std::uint8_t> frame{19, 6, oi::kEncoderLeft, 0, 0, oi::kEncoderRight, 0, 0};
    frame[3] = frame[6] = static_cast<std::uint8_t>(4 * i >> 8);
    frame[4] = frame[7] = static_cast<std::uint8_t>(4 * i & 255);
    int sum = 0;
    for (const std::uint8_t byte : frame) sum += byte;
    frame.push_back(static_cast<std::uint8_t>(-sum));
    log += format_robot_log_line(1.1 + 0.015 * i, true, frame);
  }
  return log;
}

double left_m(const WheelLog& log) {
  double sum = 0;
  for (const OdometrySample& sample : log.travel) sum += sample.left_m;
  return sum;
}

}  // namespace

TEST_GROUP(WheelLog) {
  TempFolder folder;
  std::string recording(const char* name, const std::string& log) {
    std::filesystem::create_directory(folder / name);
    folder.file(std::string(name) + "/robot.log", log);
    return folder / name;
  }
};

// Driven once as the robot came, and once with wheels as they were measured: the wheels were the same.
TEST(WheelLog, DrivesOfOneRobotAreCountedByTheSameWheels) {
  const std::string raw = recording("raw", a_turn(RobotModel::kCreate2, nullptr));
  const std::string measured = recording("measured", a_turn(RobotModel::kCreate2, &kAsMeasured));
  const WheelLog first = read_wheel_log(raw, nullptr), second = read_wheel_log(measured, &first);
  DOUBLES_EQUAL(0.2258, left_m(first), 0.0002);
  DOUBLES_EQUAL(left_m(first), left_m(second), 1e-9);
  DOUBLES_EQUAL(first.wheels.wheel_diameter_m, second.wheels.wheel_diameter_m, 0);
  const WheelLog alone = read_wheel_log(measured, nullptr);
  DOUBLES_EQUAL(0.0742, alone.wheels.wheel_diameter_m, 1e-9);
  DOUBLES_EQUAL(0.2258 * 0.0742 / 0.072 * 2 / 2.02, left_m(alone), 0.0002);
  DOUBLES_EQUAL(left_m(alone), left_m(read_wheel_log(raw, &alone)), 1e-9);
}

TEST(WheelLog, TwoModelsAreNotOneRobot) {
  const WheelLog first = read_wheel_log(recording("two", a_turn(RobotModel::kCreate2, nullptr)), nullptr);
  const std::string other = recording("one", a_turn(RobotModel::kCreate1, nullptr));
  CHECK_THROWS(Failure, read_wheel_log(other, &first));
  CHECK_THROWS(Failure, read_wheel_log(folder / "nowhere", nullptr));
}
