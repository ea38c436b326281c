#include "hal/create/wheel_travel.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "hal/create/oi.hpp"

using namespace st;

namespace {

const RobotGeometry kCreate2 = oi::default_geometry(RobotModel::kCreate2);
const RobotGeometry kCreate1 = oi::default_geometry(RobotModel::kCreate1);

SensorState encoders(int left, int right) {
  SensorState s;
  s.set(oi::kEncoderLeft, static_cast<std::int16_t>(left));
  s.set(oi::kEncoderRight, static_cast<std::int16_t>(right));
  return s;
}

SensorState requests(int left_mmps, int right_mmps) {
  SensorState s;
  s.set(oi::kRequestedLeft, left_mmps);
  s.set(oi::kRequestedRight, right_mmps);
  return s;
}

}  // namespace

TEST_GROUP(WheelTravel){};

TEST(WheelTravel, CountsPassThroughTheWrapBothWays) {
  const double m = 0.000444565;  // per count, as the reference says
  WheelTravel travel(RobotModel::kCreate2, kCreate2);
  OdometrySample sample;
  CHECK_FALSE(travel.update(0.000, encoders(65530, 5), false, sample));
  CHECK(travel.update(0.015, encoders(5, 65530), false, sample));
  DOUBLES_EQUAL(11 * m, sample.left_m, 1e-8);
  DOUBLES_EQUAL(-11 * m, sample.right_m, 1e-8);
  CHECK(travel.update(0.030, encoders(5, 65530), false, sample));
  DOUBLES_EQUAL(0, sample.left_m, 0);
  // Through the sign change in the middle.
  WheelTravel middle(RobotModel::kCreate2, kCreate2);
  middle.update(0, encoders(32760, 32775), false, sample);
  CHECK(middle.update(0.015, encoders(32775, 32760), false, sample));
  DOUBLES_EQUAL(15 * m, sample.left_m, 1e-8);
  DOUBLES_EQUAL(-15 * m, sample.right_m, 1e-8);
}

TEST(WheelTravel, AJumpIsRefusedAndARestartedRobotIsTakenUpAgain) {
  WheelTravel travel(RobotModel::kCreate2, kCreate2);
  OdometrySample sample;
  travel.update(0.000, encoders(1000, 1000), false, sample);
  CHECK_FALSE(travel.update(0.015, encoders(9000, 1000), false, sample));
  CHECK(travel.update(0.030, encoders(1010, 1010), false, sample));  // it was a damaged frame
  DOUBLES_EQUAL(0.00444565, sample.left_m, 1e-7);
  CHECK_FALSE(travel.update(0.045, encoders(20000, 20000), false, sample));
  CHECK(travel.update(0.060, encoders(20004, 20004), false, sample));  // it is the robot that restarted
  DOUBLES_EQUAL(4 * 0.000444565, sample.left_m, 1e-7);
}

TEST(WheelTravel, LostFramesLoseNoEncoderTravel) {
  WheelTravel travel(RobotModel::kCreate2, kCreate2);
  OdometrySample sample;
  travel.update(0, encoders(0, 0), false, sample);
  CHECK(travel.update(1.0, encoders(1000, 900), true, sample));
  DOUBLES_EQUAL(0.444565, sample.left_m, 1e-5);
}

TEST(WheelTravel, Create1IntegratesTheRequestedSpeeds) {
  WheelTravel travel(RobotModel::kCreate1, kCreate1);
  OdometrySample sample;
  double left = 0, right = 0;
  for (int i = 0; i <= 100; ++i) {
    if (!travel.update(i * 0.015, requests(150, 250), false, sample)) continue;
    left += sample.left_m;
    right += sample.right_m;
  }
  DOUBLES_EQUAL(0.15 * 1.5, left, 1e-9);
  DOUBLES_EQUAL(0.25 * 1.5, right, 1e-9);
}

// 20 deg/s, angle read every 0.3 s as whole degrees, whether or not the firmware keeps the fraction: the
// rounding must not reach the result, and what the wheels were kept from doing must.
TEST(WheelTravel, Create1AngleCorrectsOnlyWhatRoundingCannotExplain) {
  for (const bool keeps_fraction : {false, true}) {
    WheelTravel travel(RobotModel::kCreate1, kCreate1);
    OdometrySample sample;
    const double w = 20 * kPi / 180, half = 500 * w * kCreate1.wheel_base_m;
    double yaw = 0, angle = 0;
    for (int i = 0; i <= 1000; ++i) {
      SensorState s = requests(static_cast<int>(std::lround(-half)), static_cast<int>(std::lround(half)));
      angle += 20 * 0.015;
      if (i % 20 == 0) {
        const int whole = static_cast<int>(angle);
        s.set(oi::kDistance, 0);
        s.set(oi::kAngle, whole);
        angle = keeps_fraction ? angle - whole : 0;
      }
      if (travel.update(i * 0.015, s, false, sample))
        yaw += (sample.right_m - sample.left_m) / kCreate1.wheel_base_m;
    }
    DOUBLES_EQUAL(w * 15.0, yaw, 0.01 * w * 15.0);
  }
}

TEST(WheelTravel, Create1NoticesThatItDidNotMove) {
  WheelTravel travel(RobotModel::kCreate1, kCreate1);
  OdometrySample sample;
  double way = 0;
  for (int i = 0; i <= 200; ++i) {
    SensorState s = requests(200, 200);
    if (i % 20 == 0) {
      s.set(oi::kDistance, 0);
      s.set(oi::kAngle, 0);
    }
    if (travel.update(i * 0.015, s, false, sample)) way += 0.5 * (sample.left_m + sample.right_m);
  }
  DOUBLES_EQUAL(0.0, way, 0.011);  // a millimetre of rounding a reading
}

TEST(WheelTravel, Create1DoesNotCompareAcrossALostReading) {
  WheelTravel travel(RobotModel::kCreate1, kCreate1);
  OdometrySample sample;
  double way = 0;
  for (int i = 0; i <= 40; ++i) {
    SensorState s = requests(200, 200);
    if (i == 0 || i == 40) {
      s.set(oi::kDistance, i == 0 ? 0 : 3);  // the reading in between cleared it and never came
      s.set(oi::kAngle, 0);
    }
    if (travel.update(i * 0.015, s, i == 39, sample)) way += sample.left_m;
  }
  DOUBLES_EQUAL(0.2 * 0.6, way, 1e-9);
}

TEST(WheelTravel, UnequalWheelsRollTheirOwnWays) {
  RobotGeometry unequal = kCreate2;
  unequal.right_to_left = 1.02;
  WheelTravel travel(RobotModel::kCreate2, unequal);
  OdometrySample sample;
  travel.update(0.000, encoders(0, 0), false, sample);
  CHECK(travel.update(0.015, encoders(20, 20), false, sample));
  DOUBLES_EQUAL(1.02, sample.right_m / sample.left_m, 1e-12);
  DOUBLES_EQUAL(20 * 0.000444565, 0.5 * (sample.left_m + sample.right_m), 1e-7);
}
