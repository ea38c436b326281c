#include "algo/control/wheel_trail.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace st;

namespace {

constexpr double kBase_m = 0.235;

// A robot that drives an arc at 0.2 m/s and 0.5 rad/s, and reports every 15 ms.
void drive(WheelTrail& trail, double from_s, double until_s) {
  constexpr double kSlot_s = 0.015, kLeft_mps = 0.2 - 0.25 * kBase_m, kRight_mps = 0.2 + 0.25 * kBase_m;
  for (double t = from_s; t < until_s; t += kSlot_s)
    trail.add({t, kLeft_mps * kSlot_s, kRight_mps * kSlot_s});
}

FrameInput frame_at(double device_t_s, double delay_s) {
  FrameInput frame;
  frame.device_t_s = device_t_s;
  frame.t_s = 1000 + device_t_s + delay_s;
  return frame;
}

}  // namespace

TEST_GROUP(WheelTrail){};

TEST(WheelTrail, tells_the_motion_between_any_two_instants) {
  WheelTrail trail(kBase_m, 0);
  drive(trail, 10, 11);
  const WheelOdometry motion = trail.between(10.207, 10.813);
  CHECK(motion.valid);
  DOUBLES_EQUAL(0.606, motion.dt_s, 1e-12);
  DOUBLES_EQUAL(0.2 * 0.606, motion.forward_m, 1e-9);
  DOUBLES_EQUAL(0.5 * 0.606, motion.turn_rad, 1e-9);
}

TEST(WheelTrail, carries_the_newest_speed_on_for_a_moment_only) {
  WheelTrail trail(kBase_m, 0);
  drive(trail, 10, 11);
  CHECK(trail.between(10.9, 11.05).valid);
  DOUBLES_EQUAL(0.2 * 0.15, trail.between(10.9, 11.05).forward_m, 1e-9);
  CHECK_FALSE(trail.between(10.9, 11.2).valid);
}

TEST(WheelTrail, knows_nothing_of_what_was_before_it_listened_or_over_a_silence) {
  WheelTrail trail(kBase_m, 0);
  CHECK_FALSE(trail.between(10.1, 10.2).valid);
  drive(trail, 10, 10.5);
  CHECK_FALSE(trail.between(9.9, 10.2).valid);
  drive(trail, 10.9, 11.3);
  CHECK_FALSE(trail.between(10.4, 10.7).valid);  // the travel is known, when it was is not
  CHECK(trail.between(10.4, 11.1).valid);        // over all of it the sum is
  CHECK(trail.between(11.0, 11.2).valid);
}

TEST(WheelTrail, takes_bursts_for_one_report) {
  WheelTrail steady(kBase_m, 0), bursts(kBase_m, 0);
  for (int i = 0; i < 60; ++i) {
    const double t = 10 + 0.015 * i, came = 10 + 0.045 * (1 + i / 3);  // three at a time, at the third's time
    steady.add({t, 0.003, 0.003});
    bursts.add({came, 0.003, 0.003});
  }
  DOUBLES_EQUAL(steady.between(10.2, 10.6).forward_m, bursts.between(10.2, 10.6).forward_m, 0.0005);
}

// USB delays some frames by up to 20 ms; the camera's own clock tells when they were taken.
TEST(WheelTrail, sees_frames_at_their_exposure_whatever_their_delay) {
  WheelTrail trail(kBase_m, 0);
  const double delays_s[] = {0.004, 0.020, 0.003, 0.011, 0.000, 0.019, 0.002, 0.014};
  drive(trail, 1000, 1001);
  for (int i = 0; i < 16; ++i) {
    FrameInput frame = frame_at(0.1 + i / 30.0, delays_s[i % 8]);
    trail.take(frame);
    LONGS_EQUAL(i > 0, frame.wheels.valid);
    if (i == 0) continue;
    DOUBLES_EQUAL(1 / 30.0, frame.wheels.dt_s, 1e-9);
    DOUBLES_EQUAL(0.2 / 30.0, frame.wheels.forward_m, 1e-6);
  }
  DOUBLES_EQUAL(1000.1 + 15 / 30.0, trail.exposure_s(), 1e-3);
}

TEST(WheelTrail, shifts_exposures_by_the_calibrated_lag) {
  WheelTrail trail(kBase_m, 0.03);
  FrameInput frame = frame_at(0.5, 0);
  trail.take(frame);
  DOUBLES_EQUAL(1000.47, trail.exposure_s(), 1e-9);
}
