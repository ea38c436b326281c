#include "hal/create/accessory.hpp"

#include "hal/create/standing_visit.hpp"
#include "hal/error.hpp"
#include "tests/hal/create/processes.hpp"

// Last: it redefines new.
#include <CppUTest/TestHarness.h>

using namespace st;
using namespace st::test;

namespace {

void check_bytes(RobotModel model, const char* line, std::initializer_list<int> expected) {
  const oi::Command command = accessory_command(model, line);
  UNSIGNED_LONGS_EQUAL_TEXT(expected.size(), command.size, line);
  std::size_t i = 0;
  for (const int byte : expected) LONGS_EQUAL_TEXT(byte, command.bytes[i++], line);
  // A command that lacks data would eat the next one.
  LONGS_EQUAL_TEXT(static_cast<int>(command.size) - 1,
                   oi::data_length(model, command.bytes[0], command.span().subspan(1)), line);
}

constexpr RobotModel kOne = RobotModel::kCreate1, kTwo = RobotModel::kCreate2;

}  // namespace

TEST_GROUP(Accessory){};

TEST(Accessory, WordsAreCommandsAsTheSpecificationHasThem) {
  check_bytes(kTwo, "leds 4 128 255", {139, 4, 128, 255});
  check_bytes(kOne, "song 15 60 16 64 32", {140, 15, 2, 60, 16, 64, 32});
  check_bytes(kTwo, "  play   3 ", {141, 3});
  check_bytes(kTwo, "digits Hi 2", {164, 'H', 'i', ' ', '2'});
  check_bytes(kTwo, "digits A", {164, 'A', ' ', ' ', ' '});
  check_bytes(kOne, "outputs 5", {147, 5});
  check_bytes(kOne, "low-side 3", {138, 3});
  check_bytes(kOne, "duty 0 64 128", {144, 0, 64, 128});
  check_bytes(kOne, "ir 255", {151, 255});
}

TEST(Accessory, RefusesWhatTheRobotWouldMistake) {
  for (const char* line :
       {"", "fly", "leds 1 2", "leds 1 2 3 4", "leds 1 2 256", "leds -1 0 0", "leds 1 x 0", "song 0",
        "song 0 60", "song 0 60 16 64", "song 4 60 16", "digits hello", "outputs 1", "ir 1"})
    CHECK_THROWS(Failure, accessory_command(kTwo, line));
  std::string long_song = "song 0";
  for (int i = 0; i < 17; ++i) long_song += " 60 8";
  CHECK_THROWS(Failure, accessory_command(kOne, long_song));
  CHECK_THROWS(Failure, accessory_command(kOne, "digits abcd"));
}

TEST(Accessory, AVisitReadsEverySensorAndLeavesTheRobotPassive) {
  for (const char* model : {"create1", "create2"}) {
    const SimulatedRobot simulated({"--model", model, "--text-every", "1"});
    RobotOptions options;
    options.port = simulated.port();
    {
      StandingVisit robot(options);
      const SensorState state = robot.all_sensors();
      const int last = robot.model() == kOne ? 42 : 58;
      for (int id = 7; id <= last; ++id) CHECK(state.has(id));
      LONGS_EQUAL(15800, state.value(oi::kVoltage));
      LONGS_EQUAL(1, state.value(oi::kOiMode));
      robot.send(accessory_command(robot.model(), "leds 2 0 255"));
      sleep_ms(50);
      LONGS_EQUAL(2, simulated.now().mode);
    }
    sleep_ms(50);
    LONGS_EQUAL(1, simulated.now().mode);
  }
}
