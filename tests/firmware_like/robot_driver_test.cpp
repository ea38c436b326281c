#include "firmware_like/robot_driver.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "algo/core/scalar_math.hpp"
#include "hal/sim/random.hpp"
#include "tests/support/fake_base.hpp"

using namespace st;

namespace {

constexpr double kFrame_s = 1.0 / 30.0, kReport_s = 0.015;
const Pose2 kObjectBase{0.03, -0.02, 2.1};  // the robot's base in the frame of the tracked object

Path long_line() {
  Path path;
  path.add_line(10);
  path.plan();
  return path;
}

// The loop around a driver in simulated time: a robot that does what it is told, its reports, its guard, and
// a camera that sees it as object 1.
class Rig {
 public:
  Rig(Steering steering, const Path* path) : driver(base, steering, path, &command, Reaction::kEnd) {}

  // Time passes until the next frame, which the driver then decides on.
  void frame(double gap_s = kFrame_s) {
    const double frame_s = t_s + gap_s;
    for (double wait_s = t_s + 0.1; wait_s < frame_s; wait_s += 0.1) {
      roll(wait_s);
      driver.wait_without_frame(t_s);
    }
    roll(frame_s);
    auto input = std::make_unique<FrameInput>();
    input->t_s = input->device_t_s = t_s;
    driver.listen(input->odometry);
    trail.take(*input);
    DriverView view;
    view.sight = {true, true, 0};
    view.wheels = input->wheels;
    if (robot_seen) view.objects.push_back(object(1, pose));
    if (stranger_seen) view.objects.push_back(object(2, {2, 1, 0.3}));
    view.trail = &trail;
    view.t_s = view.host_now_s = t_s;
    driver.decide(t_s, view);
    driver.send();
    told_s_ = t_s;
  }
  void frames(double for_s) {
    for (const double until_s = t_s + for_s; t_s < until_s;) frame();
  }
  // Until the start motion has told which object is the robot, and it drives.
  void pick() {
    for (int i = 0; i < 600 && driver.served().state != std::string("driving"); ++i) frame();
    LONGS_EQUAL(1, driver.picked().id);
  }
  void ask(double v_mps, double w_rps) { command.put({static_cast<std::int64_t>(t_s * 1e9), v_mps, w_rps}); }
  // How long it goes on from now; longer than `most_s` when it does not stop.
  double moves_for_s(double most_s) {
    const double from_s = t_s;
    while (!stands() && t_s - from_s <= most_s) frame();
    return t_s - from_s;
  }
  bool stands() const { return base.left == 0 && base.right == 0; }

  FakeBase base;
  NewestCommand command;
  RobotDriver driver;
  WheelTrail trail{0.235, 0};
  Pose2 pose;
  double t_s = 100;
  bool moves = true;  // when it is told to
  bool robot_seen = true, stranger_seen = false;
  double farthest_m = 0, farthest_rad = 0;

 private:
  static SeenObject object(int id, const Pose2& base) {
    SeenObject object;
    object.id = id;
    object.good = object.has_heading = true;
    object.pose = compose(base, inverse(kObjectBase));
    return object;
  }
  void roll(double until_s) {
    while (t_s < until_s) {
      const double next_s = std::min(until_s, report_s_ + kReport_s), dt_s = next_s - t_s;
      if (t_s - told_s_ > 0.001 * kGuardPatience_ms) base.stop();
      slot_.left_m += base.left * dt_s;
      slot_.right_m += base.right * dt_s;
      if (moves)
        pose = advanced(pose, 0.5 * (base.left + base.right) * dt_s, (base.right - base.left) / 0.235 * dt_s);
      farthest_m = std::max(farthest_m, std::hypot(pose.x, pose.y));
      farthest_rad = std::max(farthest_rad, std::fabs(pose.yaw));
      t_s = next_s;
      if (t_s < report_s_ + kReport_s) continue;
      slot_.t_s = report_s_ = t_s;
      base.reports.push_back(slot_);
      slot_ = {};
    }
  }

  double report_s_ = t_s, told_s_ = t_s;
  OdometrySample slot_;
};

}  // namespace

TEST_GROUP(RobotDriver){};

TEST(RobotDriver, TheDriverStandsForAsLongAsItIsHeldAndGoesOnWithItsPath) {
  FakeBase base;
  const Path path = long_line();
  RobotDriver driver(base, Steering::kOpenLoop, &path, nullptr, Reaction::kHold);
  FixedVector<OdometrySample, 64> odometry;
  DriverView view;
  const auto drive = [&](double from_s, double to_s, const Sight& sight) {
    for (double t = from_s; t < to_s; t += 1 / 30.0) {
      driver.listen(odometry);
      view.sight = sight;
      driver.decide(t, view);
      driver.send();
    }
  };
  drive(0, 4, {true, true, 0.02});
  DOUBLES_EQUAL(0.2, base.left, 0.01);
  drive(4, 8, {true, true, 0.5});  // frames come half a second late
  DOUBLES_EQUAL(0.0, base.left, 0);
  CHECK(driver.held_by() == RobotFault::kStale && driver.fault() == RobotFault::kNone);
  drive(8, 9, {true, true, 0.02});
  DOUBLES_EQUAL(0.2, base.left, 0.01);
  driver.wait_without_frame(9.1);
  CHECK(base.left > 0);
  driver.wait_without_frame(9.3);
  DOUBLES_EQUAL(0.0, base.left, 0);
  drive(9.4, 10, {true, true, 0.02});
  base.fault = RobotFault::kCliff;
  drive(10, 10.1, {true, true, 0.02});
  DOUBLES_EQUAL(0.0, base.left, 0);
  CHECK(driver.fault() == RobotFault::kCliff);
}

// A loop that is starved has frames a fifth of a second apart: the wheels must not be thrown to and fro.
TEST(RobotDriver, LateFramesDoNotMakeTheDriverOvershoot) {
  FakeBase base;
  Path path;
  path.add_line(0.5);
  path.plan();
  RobotDriver driver(base, Steering::kOpenLoop, &path, nullptr, Reaction::kEnd);
  DriverView view;
  view.sight = {true, true, 0.1};
  double way_m = 0;
  for (double t = 0; t < 12; t += 0.19) {
    driver.decide(t, view);
    driver.send();
    CHECK(base.left > -0.03 && base.left < 0.26);
    way_m += 0.19 * base.left;
  }
  DOUBLES_EQUAL(0.5, way_m, 0.01);
}

// Frames that come when they like, with a stall now and then: the start motion keeps its allowance.
TEST(RobotDriver, TheStartMotionStaysWithinItsAllowanceHoweverFramesCome) {
  const Path path = long_line();
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    sim::Random random(seed);
    Rig rig(Steering::kClosedLoop, &path);
    const double longest_s = 0.06 + 0.5 * random.uniform();
    while (rig.driver.picked().id == 0 && rig.driver.fault() == RobotFault::kNone)
      rig.frame(0.005 + random.uniform() * random.uniform() * longest_s);
    CHECK(rig.farthest_m > 0.03 && rig.farthest_rad > 0.1);
    CHECK(rig.farthest_m <= kStartAllowance_m + 0.001);
    CHECK(rig.farthest_rad <= kStartAllowance_rad + 0.005);
  }
}

// Something else is seen all the while, and stays good: it is not the robot.
TEST(RobotDriver, TheRobotItselfHasToBeSeen) {
  const Path path = long_line();
  for (const Steering steering : {Steering::kClosedLoop, Steering::kClient}) {
    Rig rig(steering, steering == Steering::kClosedLoop ? &path : nullptr);
    rig.stranger_seen = true;
    rig.pick();
    for (int i = 0; i < 15; ++i) rig.ask(0.1, 0), rig.frame();
    CHECK_FALSE(rig.stands());
    CHECK(rig.driver.served().seen);
    rig.robot_seen = false;
    const double lost_s = rig.t_s, lost_x_m = rig.pose.x;
    while (rig.driver.fault() == RobotFault::kNone && rig.t_s < lost_s + 10) rig.ask(0.1, 0), rig.frame();
    CHECK(rig.driver.fault() == RobotFault::kNotSeen);
    CHECK(rig.stands());
    CHECK(rig.t_s - lost_s <= kBlindTime_s + 2 * kFrame_s);
    CHECK(rig.pose.x - lost_x_m <= kBlindDistance_m + 0.02);
  }
}

TEST(RobotDriver, AClientIsObeyedAfterTheStartMotionAloneAndForAsLongAsItSpeaks) {
  Rig rig(Steering::kClient, nullptr);
  rig.ask(0.2, 0);
  while (rig.driver.served().state == std::string("learning")) {
    CHECK(rig.stands());
    rig.ask(0.2, 0);
    rig.frame();
  }
  rig.pick();
  CHECK(rig.stands());  // what it asked for meanwhile is old
  for (int i = 0; i < 30; ++i) rig.ask(0.2, 0.4), rig.frame();
  DOUBLES_EQUAL(0.2 - 0.4 * 0.5 * 0.235, rig.base.left, 1e-6);
  DOUBLES_EQUAL(0.2 + 0.4 * 0.5 * 0.235, rig.base.right, 1e-6);
  const double silent_s = rig.moves_for_s(5);  // alive, but it says nothing any more
  CHECK(silent_s > kClientPatience_s - 2 * kFrame_s && silent_s <= kClientPatience_s + 2 * kFrame_s);
  CHECK(rig.driver.fault() == RobotFault::kNone);
  rig.ask(0.2, 0);
  rig.frame();
  DOUBLES_EQUAL(0.2, rig.base.left, 1e-6);
  rig.ask(0, 0);
  rig.ask(0.2, 0);
  rig.frame();
  CHECK(rig.stands());  // a stop is never overlooked
}

TEST(RobotDriver, NothingIsDrivenWhenNothingObeys) {
  const Path path = long_line();
  for (const Steering steering : {Steering::kClosedLoop, Steering::kClient}) {
    Rig rig(steering, steering == Steering::kClosedLoop ? &path : nullptr);
    rig.moves = false;  // what is seen is another robot, which stands
    while (rig.driver.fault() == RobotFault::kNone && rig.t_s < 200) {
      rig.ask(0.3, 0);
      rig.frame();
      CHECK(std::fabs(rig.base.left) < 0.2);  // never more than a start motion
    }
    CHECK(rig.driver.fault() == RobotFault::kNotSeen);
    LONGS_EQUAL(0, rig.driver.picked().id);
    rig.ask(0.3, 0);
    rig.frames(1);
    CHECK(rig.stands());
  }
}

// Frames that come so late that the robot stands in between: what it drove until it stood counts as well.
TEST(RobotDriver, LateFramesDoNotLetItDriveBlindForEver) {
  const Path path = long_line();
  Rig rig(Steering::kClosedLoop, &path);
  rig.pick();
  rig.robot_seen = false;
  for (int i = 0; i < 60 && rig.driver.fault() == RobotFault::kNone; ++i) rig.frame(0.3);
  CHECK(rig.driver.fault() == RobotFault::kNotSeen);
}

// Rolled aside by hand during the start motion: it is not to race back.
TEST(RobotDriver, APushDuringTheStartMotionIsNotAnswered) {
  Rig rig(Steering::kClosedLoop, nullptr);
  for (int i = 0; i < 200 && rig.driver.served().state != std::string("start_motion"); ++i) rig.frame();
  rig.base.reports.push_back({rig.t_s, 0.3, 0.3});
  double fastest_mps = 0;
  for (int i = 0; i < 90; ++i) {
    rig.frame();
    fastest_mps = std::max({fastest_mps, std::fabs(rig.base.left), std::fabs(rig.base.right)});
  }
  CHECK(fastest_mps < 0.15);
}
