// The whole chain in simulated time: path, follower, bytes, robot, bytes, wheel travel.
#include <CppUTest/TestHarness.h>

#include <cmath>

#include "algo/control/dead_reckoning.hpp"
#include "algo/control/follower.hpp"
#include "algo/core/scalar_math.hpp"
#include "hal/create/odometry_decoder.hpp"
#include "tests/hal/create/sim/engine_talk.hpp"

using namespace st;
using namespace st::test;
using sim::CreateEngine;
using sim::CreateOptions;

TEST_GROUP(CreateWay){};

// 100 m in both directions, through the wrap of both encoders: only the wheels' own size may show.
TEST(CreateWay, OdometryOverAHundredMetresErrsByScaleAlone) {
  for (const RobotModel model : {RobotModel::kCreate1, RobotModel::kCreate2}) {
    CreateOptions options;
    options.model = model;
    options.errors.left_scale = options.errors.right_scale = 1.02;
    CreateEngine robot(options);
    RobotGeometry wheels = oi::default_geometry(model);
    wheels.wheel_diameter_m *= 1.02;  // as measured
    OdometryStream stream(model, wheels);
    DeadReckoning reckoning(wheels.wheel_base_m);
    Path path;
    path.limits.speed_mps = 0.4;
    double travelled_m = 0;
    for (int i = 0; i < 4; ++i) {
      path.add_line(15);
      path.add_turn(kPi / 2);
      path.add_line(-10);
      path.add_arc(0.5, -kPi / 2);
    }
    path.plan();
    const std::vector<std::uint8_t> lists[] = {{41, 42, 43, 44}, {41, 42}, {41, 42, 19, 20}};
    say(robot, {128, 131}, 0.1);
    hear(robot);
    OpenLoopFollower follower(path, oi::default_geometry(model).wheel_base_m);
    const auto listen = [&](double t_s) {
      const auto bytes = hear(robot);
      stream.receive(
          t_s, bytes, [](const SensorState&) {},
          [&](const OdometrySample& s) {
            reckoning.add(s);
            travelled_m += 0.5 * std::fabs(s.left_m + s.right_m);
          });
    };
    double t_s = 0;
    for (int tick = 0; !follower.done() || tick % 20 != 0; ++tick, t_s += 0.015) {
      const WheelSpeeds s = follower.step(0.015, 0.015);
      robot.receive(oi::drive_direct(static_cast<int>(std::lround(s.left_mps * 1000)),
                                     static_cast<int>(std::lround(s.right_mps * 1000)))
                        .span());
      const auto& list = model == RobotModel::kCreate2 ? lists[0] : tick % 20 == 10 ? lists[2] : lists[1];
      robot.receive(oi::stream(list).span());
      stream.sent(oi::stream(list).span());
      robot.step(0.015);
      listen(t_s);
    }
    robot.receive(oi::halt().span());
    for (int i = 0; i < 20; ++i, t_s += 0.015) {
      robot.step(0.015);
      listen(t_s);
    }
    const Pose2 truth = robot.body().pose(), told = reckoning.pose();
    CHECK(travelled_m > 100);
    const bool encoders = model == RobotModel::kCreate2;
    DOUBLES_EQUAL(truth.yaw, told.yaw, encoders ? 0.002 : 0.03);
    // A Create 1 tells its angle in whole degrees: half of one over all the way.
    CHECK(std::hypot(truth.x - told.x, truth.y - told.y) <
          (encoders ? 0.005 : travelled_m * 0.5 * kPi / 180));
    UT_PRINT(StringFromFormat("%s, %.0f m: %.1f mm and %.2f deg off", encoders ? "Create 2" : "Create 1",
                              travelled_m, 1000 * std::hypot(truth.x - told.x, truth.y - told.y),
                              (told.yaw - truth.yaw) * 180 / kPi)
                 .asCharString());
  }
}

TEST(CreateWay, ACircleDrivenOpenLoopHasItsRadius) {
  for (const RobotModel model : {RobotModel::kCreate1, RobotModel::kCreate2}) {
    CreateOptions options;
    options.model = model;
    CreateEngine robot(options);
    say(robot, {128, 131});
    Path path;
    path.add_arc(0.5, 2 * kPi);
    path.plan();
    OpenLoopFollower follower(path, oi::default_geometry(model).wheel_base_m);
    double worst = 0;
    while (!follower.done()) {
      const WheelSpeeds s = follower.step(0.02, 0.02);
      robot.receive(oi::drive_direct(static_cast<int>(std::lround(s.left_mps * 1000)),
                                     static_cast<int>(std::lround(s.right_mps * 1000)))
                        .span());
      robot.step(0.02);
      const Pose2 at = robot.body().pose();
      worst = std::max(worst, std::fabs(std::hypot(at.x, at.y - 0.5) - 0.5));
    }
    robot.receive(oi::halt().span());
    robot.step(1);
    CHECK(worst < 0.004);
    DOUBLES_EQUAL(0.0, std::hypot(robot.body().pose().x, robot.body().pose().y), 0.01);
    DOUBLES_EQUAL(2 * kPi, robot.body().pose().yaw, 0.01);
  }
}
