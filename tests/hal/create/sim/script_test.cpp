#include <CppUTest/TestHarness.h>

#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "tests/hal/create/sim/engine_talk.hpp"

using namespace st;
using namespace st::test;
using sim::CreateEngine;

TEST_GROUP(CreateScript){};

// The circle of the specification: 200 mm/s on 500 mm to the left, wait for 360 degrees, stop.
TEST(CreateScript, DrivesACircleAndListensToNobodyMeanwhile) {
  CreateEngine robot = CreateEngine(create1());
  say(robot, {128, 131, 152, 13, 137, 0, 200, 1, 244, 157, 1, 104, 137, 0, 0, 0, 0});
  say(robot, {148, 1, 35}, 0.1);
  hear(robot);
  say(robot, {153}, 1.0);
  CHECK(robot.in_script_wait());
  hear(robot);
  say(robot, {145, 0, 0, 0, 0}, 1.0);  // nobody hears this stop, and no stream tells
  CHECK(robot.in_script_wait());
  DOUBLES_EQUAL(0.2, robot.body().v(), 0.01);
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  robot.step(20.0);
  CHECK_FALSE(robot.in_script_wait());
  CHECK(robot.standing());
  DOUBLES_EQUAL(2 * kPi, robot.body().pose().yaw, 0.1);
  DOUBLES_EQUAL(0.0, std::hypot(robot.body().pose().x, robot.body().pose().y), 0.06);
  CHECK(!hear(robot).empty());
}

TEST(CreateScript, AWaitOfTheWrongSignNeverEnds) {
  CreateEngine robot = CreateEngine(create1());
  say(robot, {128, 131, 152, 8, 137, 0, 200, 1, 244, 157, 254, 152, 153}, 60);
  CHECK(robot.in_script_wait());
  CHECK(robot.body().pose().yaw > 4 * kPi);
}

TEST(CreateScript, ItsReflexesStillGuardItInAWait) {
  CreateEngine robot = CreateEngine(create1());
  say(robot, {128, 131, 152, 8, 137, 0, 200, 1, 244, 155, 200, 137, 0, 153}, 1);
  robot.world().wheel_drops = 4;
  robot.step(0.5);
  CHECK(robot.standing());
  LONGS_EQUAL(oi::kPassive, robot.mode());
}

TEST(CreateScript, WaitsForDistanceTimeAndEvents) {
  CreateEngine robot = CreateEngine(create1());
  say(robot, {128, 131, 145, 0, 200, 0, 200, 156, 1, 44, 145, 0, 0, 0, 0}, 3);  // 300 mm, then stop
  CHECK(robot.standing());
  DOUBLES_EQUAL(0.3, robot.body().pose().x, 0.02);
  say(robot, {155, 10, 142, 35}, 0.8);
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  robot.step(0.3);
  UNSIGNED_LONGS_EQUAL(1, hear(robot).size());
  say(robot, {158, 5, 142, 35}, 5);  // a bump
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  robot.world().bump_left = true;
  robot.step(0.1);
  UNSIGNED_LONGS_EQUAL(1, hear(robot).size());
  say(robot, {158, 251, 142, 35}, 1);  // until no bump
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  robot.world().bump_left = false;
  robot.step(0.1);
  UNSIGNED_LONGS_EQUAL(1, hear(robot).size());
}

TEST(CreateScript, AScriptThatPlaysItselfGoesOnForEver) {
  CreateEngine robot = CreateEngine(create1());
  say(robot, {128, 131, 152, 8, 145, 0, 100, 0, 100, 155, 1, 153}, 0.1);
  say(robot, {153}, 10);
  DOUBLES_EQUAL(0.1, robot.body().v(), 1e-9);
  say(robot, {145, 0, 0, 0, 0, 7}, 1);  // and from the host it hears nothing more
  CHECK_FALSE(robot.standing());
  CreateEngine other = CreateEngine(create1());  // without a wait it must not hold up time
  say(other, {128, 131, 152, 1, 153, 153}, 1);
  CHECK(other.standing());
}

TEST(CreateScript, ShowsWhatIsStoredAndThenTheStreamIsQuiet) {
  CreateEngine robot = CreateEngine(create1());
  say(robot, {128, 152, 2, 155, 5, 148, 1, 35}, 0.1);
  hear(robot);
  say(robot, {154}, 0.2);
  const auto bytes = hear(robot);
  const std::size_t n = bytes.size();
  CHECK(n >= 3 && bytes[n - 3] == 2 && bytes[n - 2] == 155 && bytes[n - 1] == 5);
}

TEST(CreateScript, TheCreate2HasNone) {
  CreateEngine robot({});
  say(robot, {128, 131, 152, 3, 128, 142, 35}, 0.1);  // passed over, byte by byte: 128 is Start
  LONGS_EQUAL(oi::kPassive, robot.mode());
}
