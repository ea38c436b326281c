#include "hal/create/sim/create_engine.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <string>
#include <vector>

#include "algo/core/scalar_math.hpp"
#include "hal/sim/random.hpp"
#include "tests/hal/create/sim/engine_talk.hpp"

using namespace st;
using namespace st::test;
using sim::CreateEngine;
using sim::CreateOptions;

TEST_GROUP(CreateEngine){};

TEST(CreateEngine, HearsOnlyStartWhileOff) {
  CreateEngine robot({});
  say(robot, {131, 142, 35});
  LONGS_EQUAL(oi::kOff, robot.mode());
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  say(robot, {128});
  LONGS_EQUAL(oi::kPassive, robot.mode());
  LONGS_EQUAL(1, ask(robot, 35));
}

TEST(CreateEngine, MovesInSafeModeAndNotInPassive) {
  CreateEngine robot({});
  say(robot, {128, 145, 0, 200, 0, 200}, 1);
  CHECK(robot.standing());
  say(robot, {131, 145, 0, 200, 0, 200}, 1);
  DOUBLES_EQUAL(0.2, robot.body().v(), 1e-9);
  LONGS_EQUAL(200, ask(robot, 41));
  say(robot, {131}, 1);  // entering Safe turns the motors off
  CHECK(robot.standing());
}

TEST(CreateEngine, SilenceGoesOnDriving) {
  CreateEngine robot({});
  say(robot, {128, 131, 145, 0, 100, 0, 100}, 60);
  DOUBLES_EQUAL(0.1, robot.body().v(), 1e-9);
  CHECK(robot.body().pose().x > 5.9);
}

TEST(CreateEngine, DriveTurnsOnItsRadius) {
  CreateEngine robot({});
  say(robot, {128, 131, 137, 0, 200, 1, 244}, 1);  // 200 mm/s, 500 mm to the left
  DOUBLES_EQUAL(0.2, robot.body().v(), 1e-9);
  DOUBLES_EQUAL(0.4, robot.body().w(), 0.01);
  say(robot, {137, 0, 200, 255, 255}, 1);  // on the spot, to the right
  DOUBLES_EQUAL(0.0, robot.body().v(), 1e-9);
  DOUBLES_EQUAL(-0.4 / 0.235, robot.body().w(), 1e-9);
}

TEST(CreateEngine, ACommandWithoutItsDataEatsTheNext) {
  CreateEngine robot({});
  say(robot, {128, 131, 145, 0, 100, 0}, 5);
  CHECK(robot.standing());
  say(robot, {145, 0, 0, 0, 0}, 1);  // 145 completes the first; the rest is no command
  DOUBLES_EQUAL(0.1225, robot.body().v(), 1e-9);
}

TEST(CreateEngine, OpcodeOneThirtySixIsLongerOnTheCreate1) {
  // As data of Demo, 131 does nothing; after Max clean it is Safe.
  CreateEngine one(create1()), two({});
  for (CreateEngine* robot : {&one, &two}) say(*robot, {128, 136, 131});
  LONGS_EQUAL(oi::kPassive, one.mode());
  LONGS_EQUAL(oi::kSafeMode, two.mode());
}

TEST(CreateEngine, SafeModeFallsToPassiveAndFullDoesNot) {
  for (const bool full : {false, true}) {
    CreateEngine robot({});
    say(robot, {128, full ? 132 : 131, 145, 0, 200, 0, 200}, 1);
    robot.world().cliffs = 1;
    robot.step(1);
    CHECK_EQUAL(full, robot.mode() == oi::kFullMode);
    CHECK_EQUAL(!full, robot.standing());
    LONGS_EQUAL(1, ask(robot, 9));
  }
  CreateEngine backwards({});
  say(backwards, {128, 131, 145, 255, 56, 255, 56}, 1);
  backwards.world().cliffs = 1;
  backwards.step(1);
  LONGS_EQUAL(oi::kSafeMode, backwards.mode());
  backwards.world().wheel_drops = 4;
  backwards.step(1);
  LONGS_EQUAL(oi::kPassive, backwards.mode());
  LONGS_EQUAL(4, ask(backwards, 7));
}

TEST(CreateEngine, ResetPrintsABannerAndTurnsOff) {
  CreateEngine robot({});
  say(robot, {128, 131, 7}, 0.1);
  const auto bytes = hear(robot);
  STRCMP_CONTAINS("r3_robot/tags/release", std::string(bytes.begin(), bytes.end()).c_str());
  LONGS_EQUAL(oi::kOff, robot.mode());
}

TEST(CreateEngine, EncodersCountTheWayAndPassTheWrap) {
  CreateEngine robot({});
  say(robot, {128, 131});
  const auto left = static_cast<std::uint16_t>(ask(robot, 43)),
             right = static_cast<std::uint16_t>(ask(robot, 44));
  CHECK(left > 64500 && right > 31700 && right < 32768);
  say(robot, {145, 1, 44, 1, 44}, 5);
  say(robot, {145, 0, 0, 0, 0}, 1);
  const auto counted = static_cast<std::uint16_t>(static_cast<std::uint16_t>(ask(robot, 43)) - left);
  DOUBLES_EQUAL(robot.body().pose().x, counted * 0.000444565, 0.001);
  CHECK(static_cast<std::uint16_t>(ask(robot, 43)) < 64500);
  CHECK(static_cast<std::uint16_t>(ask(robot, 44)) > 32768);
}

TEST(CreateEngine, DistanceAndAngleClearOnReading) {
  CreateEngine robot(create1());
  say(robot, {128, 131, 145, 0, 0, 0, 0});
  ask(robot, 19);
  say(robot, {145, 0, 200, 0, 200}, 2);
  say(robot, {145, 0, 0, 0, 0}, 1);
  DOUBLES_EQUAL(robot.body().pose().x * 1000, ask(robot, 19), 1.5);
  LONGS_EQUAL(0, ask(robot, 19));
  say(robot, {137, 0, 100, 0, 1}, 2);  // to the left, on the spot
  say(robot, {145, 0, 0, 0, 0}, 1);
  DOUBLES_EQUAL(robot.body().pose().yaw * 180 / kPi, ask(robot, 20), 1.5);
  LONGS_EQUAL(0, ask(robot, 20));
}

TEST(CreateEngine, ReadingTheAngleTooOftenLosesItWhereTheFractionIsNotKept) {
  for (const bool keeps : {false, true}) {
    CreateOptions options = create1();
    options.angle_keeps_fraction = keeps;
    CreateEngine robot(options);
    say(robot, {128, 131, 137, 0, 50, 0, 1}, 0.5);  // 22 deg/s
    ask(robot, 20);
    const double before = robot.body().pose().yaw;
    int sum = 0;
    for (int i = 0; i < 60; ++i) sum += ask(robot, 20);  // every 20 ms: 0.44 deg
    const double turned = (robot.body().pose().yaw - before) * 180 / kPi;
    if (keeps)
      DOUBLES_EQUAL(turned, sum, 1.5);
    else
      LONGS_EQUAL(0, sum);
  }
}

TEST(CreateEngine, FallsAsleepIdleInPassiveAndHearsNothingUntilItsButtonIsPressed) {
  CreateEngine robot({});
  say(robot, {128}, 299);
  LONGS_EQUAL(oi::kPassive, robot.mode());
  robot.step(2);
  CHECK(robot.asleep());
  say(robot, {128, 128, 142, 35}, 1);
  UNSIGNED_LONGS_EQUAL(0, hear(robot).size());
  robot.press_power();
  say(robot, {128}, 0.1);
  LONGS_EQUAL(1, ask(robot, 35));
  CreateEngine one(create1()), safe({});
  say(one, {128}, 400);
  CHECK_FALSE(one.asleep());  // its specification knows no sleep
  say(safe, {128, 131}, 400);
  CHECK_FALSE(safe.asleep());  // in Safe it runs its battery down instead
}

TEST(CreateEngine, SeeksTheDockByItselfAndStandsOnIt) {
  CreateEngine robot({});
  robot.world().dock_near = true;
  say(robot, {128, 142, 17}, 0.1);
  LONGS_EQUAL(173, hear(robot).back());
  say(robot, {143}, 1);
  CHECK(robot.body().v() > 0);
  LONGS_EQUAL(oi::kPassive, robot.mode());
  robot.step(3);
  CHECK(robot.standing());
  CHECK(robot.world().on_charger);
  LONGS_EQUAL(2, ask(robot, 34));
  robot.world().charging_state = 6;  // which the Create 2's own table allows
  LONGS_EQUAL(6, ask(robot, 21));
  CreateEngine stopped({});
  stopped.world().dock_near = true;
  say(stopped, {128, 143}, 1);
  say(stopped, {131}, 1);  // what ends it
  CHECK(stopped.standing());
}

TEST(CreateEngine, BlockedWheelsTellByTheirCurrents) {
  CreateEngine robot({});
  say(robot, {128, 131, 145, 0, 200, 0, 200}, 0.5);
  robot.world().blocked = true;
  robot.step(1);
  CHECK(robot.standing());
  LONGS_EQUAL(24, ask(robot, 14));
  CHECK(ask(robot, 54) > 1000);
  LONGS_EQUAL(0, ask(robot, 58));
}

TEST(CreateEngine, LightsAndOutputsAreKept) {
  CreateEngine robot(create1());
  say(robot, {128, 139, 2, 0, 255}, 0.1);
  LONGS_EQUAL(0, robot.lights()[0]);  // not in Passive
  say(robot, {131, 139, 2, 10, 255, 147, 5, 138, 3}, 0.1);
  LONGS_EQUAL(2, robot.lights()[0]);
  LONGS_EQUAL(10, robot.lights()[1]);
  LONGS_EQUAL(5 << 8 | 3, robot.outputs());
}

TEST(CreateEngine, AnyBytesWhateverDoNoHarm) {
  sim::Random random(23);
  for (const RobotModel model : {RobotModel::kCreate1, RobotModel::kCreate2}) {
    CreateOptions options;
    options.model = model;
    CreateEngine robot(options);
    for (int i = 0; i < 3000; ++i) {
      std::vector<std::uint8_t> bytes(static_cast<std::size_t>(1 + random.below(30)));
      for (auto& b : bytes)
        b = static_cast<std::uint8_t>(random.below(3) == 0 ? 128 + random.below(46) : random.below(256));
      robot.receive(bytes);
      robot.step(0.01);
      hear(robot);
      CHECK(std::fabs(robot.body().v()) <= 0.5 + 1e-9);
    }
  }
}
