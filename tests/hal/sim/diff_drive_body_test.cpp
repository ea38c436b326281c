#include "hal/sim/diff_drive_body.hpp"

#include <CppUTest/TestHarness.h>

#include "algo/core/scalar_math.hpp"

using namespace st;

TEST_GROUP(DiffDriveBody){};

TEST(DiffDriveBody, ReachesTheCommandedSpeedAtTheAccelerationLimit) {
  DiffDriveBody body(0.235, 1.0, {}, 1);
  body.command(0.2, 0.2);
  body.step(0.1);
  DOUBLES_EQUAL(0.1, body.left_mps(), 1e-9);
  DOUBLES_EQUAL(0.5 * 1.0 * 0.1 * 0.1, body.pose().x, 1e-9);
  body.step(0.9);
  DOUBLES_EQUAL(0.2, body.v(), 1e-12);
  DOUBLES_EQUAL(0.2 * 1.0 - 0.02, body.pose().x, 1e-9);
}

TEST(DiffDriveBody, DrivesTheCircleThatItsWheelSpeedsSay) {
  const double base = 0.235, v = 0.2, radius = 0.5;
  DiffDriveBody body(base, 1000.0, {}, 1);
  body.command(v * (1 - base / 2 / radius), v * (1 + base / 2 / radius));
  body.step(kPi * radius / v);  // half the circle, to the left
  DOUBLES_EQUAL(0.0, body.pose().x, 1e-3);
  DOUBLES_EQUAL(2 * radius, body.pose().y, 1e-3);
  DOUBLES_EQUAL(kPi, body.pose().yaw, 1e-3);
}

TEST(DiffDriveBody, WheelSizeErrorTurnsAStraightLineButNotTheEncoders) {
  DiffDriveBody body(0.235, 1000.0, {0.97, 1.0, 0.0}, 1);
  body.command(0.2, 0.2);
  body.step(1.0);
  DOUBLES_EQUAL(0.2, body.left_mps(), 1e-12);
  DOUBLES_EQUAL(0.2 * 0.03 / 0.235, body.pose().yaw, 1e-4);
}

TEST(DiffDriveBody, HowTheTimeIsCutDoesNotChangeTheWay) {
  DiffDriveBody a(0.235, 1.0, {1, 1, 0.05}, 7), b(0.235, 1.0, {1, 1, 0.05}, 7);
  a.command(0.1, 0.3);
  b.command(0.1, 0.3);
  for (int i = 0; i < 60; ++i) a.step(1.0 / 60);
  for (int i = 0; i < 1000; ++i) b.step(0.001);
  DOUBLES_EQUAL(a.pose().x, b.pose().x, 1e-6);
  DOUBLES_EQUAL(a.pose().yaw, b.pose().yaw, 1e-6);
}

TEST(DiffDriveBody, SlipHasTheStatedSpreadAndDependsOnTheSeed) {
  double sum = 0, sum2 = 0;
  const int n = 400;
  for (int seed = 1; seed <= n; ++seed) {
    DiffDriveBody body(0.235, 1000.0, {1, 1, 0.05}, static_cast<std::uint64_t>(seed));
    body.command(0.2, 0.2);
    body.step(2.0);
    sum += body.v();
    sum2 += body.v() * body.v();
  }
  const double mean = sum / n, sigma = std::sqrt(sum2 / n - mean * mean);
  DOUBLES_EQUAL(0.2, mean, 0.002);
  DOUBLES_EQUAL(0.2 * 0.05 / std::sqrt(2.0), sigma, 0.001);
}

TEST(DiffDriveBody, PlacedSomewhereItStands) {
  DiffDriveBody body(0.235, 1.0, {}, 1);
  body.command(0.2, 0.2);
  body.step(1.0);
  body.place({1, 2, 3});
  body.step(1.0);
  DOUBLES_EQUAL(1.0, body.pose().x, 0);
  DOUBLES_EQUAL(3.0, body.pose().yaw, 0);
}
