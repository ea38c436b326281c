// Words with a simulated Create, in its own time.
#pragma once

#include <CppUTest/TestHarness.h>

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "hal/create/sim/create_engine.hpp"

namespace st::test {

inline sim::CreateOptions create1() {
  sim::CreateOptions options;
  options.model = RobotModel::kCreate1;
  return options;
}

inline void say(sim::CreateEngine& robot, std::initializer_list<int> bytes, double wait_s = 0.02) {
  std::vector<std::uint8_t> command;
  for (const int b : bytes) command.push_back(static_cast<std::uint8_t>(b));
  robot.receive(command);
  robot.step(wait_s);
}

inline std::vector<std::uint8_t> hear(sim::CreateEngine& robot) {
  std::vector<std::uint8_t> bytes(100000);
  bytes.resize(robot.transmit(bytes));
  return bytes;
}

// What a packet says, as a signed number.
inline int ask(sim::CreateEngine& robot, int packet) {
  hear(robot);
  say(robot, {142, packet});
  const auto reply = hear(robot);
  if (reply.size() == 1) return reply[0];
  UNSIGNED_LONGS_EQUAL(2, reply.size());
  return static_cast<std::int16_t>(reply[0] << 8 | reply[1]);
}

}  // namespace st::test
