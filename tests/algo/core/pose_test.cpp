#include "algo/core/pose.hpp"

#include <CppUTest/TestHarness.h>

#include "algo/core/scalar_math.hpp"

using namespace st;

TEST_GROUP(Pose){};

TEST(Pose, RotationVectorRoundTripsOverTheWholeTurn) {
  for (int i = 1; i < 31; ++i) {
    const Vec3 axis = normalized(Vec3{0.3 + i, -1.0, 0.2 * i});
    const Vec3 r = axis * (0.1 * i);
    const Vec3 back = rotation_to_vector(rotation_from_vector(r));
    DOUBLES_EQUAL(0.0, norm(back - r), 1e-12);
  }
}

TEST(Pose, InverseUndoesTheMotion) {
  const Pose T{rotation_from_vector({0.4, -0.2, 1.1}), {1, 2, 3}};
  const Vec3 p{0.3, -0.7, 2.0};
  DOUBLES_EQUAL(0.0, norm(T.inverse() * (T * p) - p), 1e-14);
}

TEST(Pose, RollPitchYawRoundTrips) {
  const Vec3 rpy{0.2, -0.4, 2.9};
  DOUBLES_EQUAL(0.0, norm(to_roll_pitch_yaw(from_roll_pitch_yaw(rpy)) - rpy), 1e-12);
}

TEST(Pose, MovingAboutAPivotLeavesThePivotWhereItIs) {
  const Pose T{rotation_from_vector({0.4, -0.2, 1.1}), {1, 2, 3}};
  const Vec3 pivot_object{0.1, 0.2, 0.3};
  const Vec3 pivot = T * pivot_object;
  const Pose moved = moved_about(T, {{}, {0.1, 0.2, -0.3}}, pivot);
  DOUBLES_EQUAL(0.0, norm(moved * pivot_object - pivot), 1e-14);
}

TEST(Pose, BetweenTwoHeadingsLiesTheShorterWay) {
  const Pose2 middle = between({0, 0, kPi - 0.1}, {2, 4, -kPi + 0.3}, 0.5);
  DOUBLES_EQUAL(0, wrap_angle(middle.yaw - (kPi + 0.1)), 1e-12);
  DOUBLES_EQUAL(1, middle.x, 0);
  DOUBLES_EQUAL(2, middle.y, 0);
}
