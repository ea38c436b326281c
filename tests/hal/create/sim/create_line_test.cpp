// What the simulated robot sends over its line, and what the line makes of it.
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <string>

#include "hal/create/oi_stream.hpp"
#include "tests/hal/create/sim/engine_talk.hpp"

using namespace st;
using namespace st::test;
using sim::CreateEngine;
using sim::CreateOptions;

TEST_GROUP(CreateLine){};

TEST(CreateLine, StreamsEveryFifteenMillisecondsWithTheChecksum) {
  CreateEngine robot({});
  say(robot, {128, 148, 2, 29, 13}, 0.3);
  const auto bytes = hear(robot);
  UNSIGNED_LONGS_EQUAL(0, bytes.size() % 8);
  CHECK(bytes.size() / 8 >= 18 && bytes.size() / 8 <= 20);
  unsigned sum = 0;
  for (int i = 0; i < 8; ++i) sum += bytes[static_cast<std::size_t>(i)];
  LONGS_EQUAL(19, bytes[0]);
  LONGS_EQUAL(5, bytes[1]);
  LONGS_EQUAL(0, sum & 255);
  say(robot, {150, 0}, 0.1);
  hear(robot);
  robot.step(0.1);
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  say(robot, {150, 1}, 0.1);
  CHECK(!hear(robot).empty());
}

TEST(CreateLine, TheLineTakesTenBitsAByte) {
  CreateEngine robot({});
  say(robot, {128});
  hear(robot);
  say(robot, {142, 100}, 0.0035);  // 80 bytes: 6.9 ms at 115200 baud
  const std::size_t early = hear(robot).size();
  CHECK(early > 20 && early < 45);
  robot.step(0.005);
  UNSIGNED_LONGS_EQUAL(80, early + hear(robot).size());
}

TEST(CreateLine, AStreamThatDoesNotFitItsSlotIsTorn) {
  CreateEngine robot(create1());
  say(robot, {128, 148, 3, 6, 6, 6}, 1);  // 159 bytes a slot, and 86 fit
  StreamParser parser(RobotModel::kCreate1);
  SensorState state;
  for (const std::uint8_t byte : hear(robot))
    for (parser.push(byte); parser.next(state);) {
    }
  UNSIGNED_LONGS_EQUAL(0, parser.good_frames());
}

TEST(CreateLine, TheWrongSpeedIsGarbageBothWays) {
  CreateEngine robot({});
  say(robot, {128, 148, 1, 35}, 0.1);
  hear(robot);
  robot.set_host_baud(57600);
  robot.step(1.0);
  StreamParser parser(RobotModel::kCreate2);
  SensorState state;
  const auto bytes = hear(robot);
  CHECK(!bytes.empty());
  for (const std::uint8_t byte : bytes)
    for (parser.push(byte); parser.next(state);) {
    }
  UNSIGNED_LONGS_EQUAL(0, parser.good_frames());
  say(robot, {131}, 0.1);
  LONGS_EQUAL(oi::kPassive, robot.mode());
}

TEST(CreateLine, TheBaudCommandChangesTheSpeed) {
  CreateEngine robot({});
  say(robot, {128, 129, 10}, 0.1);
  LONGS_EQUAL(57600, robot.baud());
  robot.set_host_baud(57600);
  LONGS_EQUAL(1, ask(robot, 35));
}

TEST(CreateLine, StartsAtTheSpeedItIsTold) {
  CreateOptions options;
  options.start_baud = 19200;
  CreateEngine robot(options);
  robot.set_host_baud(19200);
  say(robot, {128}, 0.1);
  LONGS_EQUAL(1, ask(robot, 35));
  say(robot, {129, 11}, 0.1);
  robot.set_host_baud(115200);
  LONGS_EQUAL(1, ask(robot, 35));
}

TEST(CreateLine, HalfFramesAndBytesTwiceAreTheOnlyOnesLost) {
  CreateOptions options;
  options.half_frames = 0.2;
  options.noise.duplicate = 0.002;
  CreateEngine robot(options);
  say(robot, {128, 148, 1, 100}, 30);
  std::vector<std::uint8_t> bytes(400000);
  bytes.resize(robot.transmit(bytes));
  StreamParser parser(RobotModel::kCreate2);
  const std::uint8_t list[] = {100};
  parser.expect(list);
  SensorState state;
  for (const std::uint8_t byte : bytes)
    for (parser.push(byte); parser.next(state);) LONGS_EQUAL(19, state.value(oi::kTemperature));
  const double share = static_cast<double>(parser.good_frames()) / 2000;
  CHECK(share > 0.6 && share < 0.75);  // 0.8 whole ones, of which 0.84 without a doubled byte
}
