#include "algo/control/footprint.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <vector>

#include "algo/core/scalar_math.hpp"

using namespace st;

TEST_GROUP(Footprint) {
  std::vector<MeshVertex> vertices;

  void add(double x, double y, double z) {
    MeshVertex v;
    v.position = to_float(Vec3{x, y, z});
    vertices.push_back(v);
  }
  void disc(double x, double y, double radius, double z0, double z1, double from = 0, double to = 2 * kPi) {
    for (int i = 0; i < 200; ++i)
      for (int k = 0; k <= 10; ++k) {
        const SinCos a = sin_cos(from + (to - from) * i / 200);
        add(x + radius * a.cos, y + radius * a.sin, z0 + (z1 - z0) * k / 10);
      }
  }
  void box(double cx, double cy, double length, double width, double yaw, double z0, double z1) {
    const SinCos h = sin_cos(yaw);
    for (int i = 0; i <= 40; ++i)
      for (int k = 0; k <= 10; ++k)
        for (const double side : {-0.5, 0.5}) {
          const double s = i / 40.0 - 0.5, z = z0 + (z1 - z0) * k / 10;
          for (const auto& [u, v] :
               {std::pair{s * length, side * width}, std::pair{side * length, s * width}})
            add(cx + h.cos * u - h.sin * v, cy + h.sin * u + h.cos * v, z);
        }
  }
};

TEST(Footprint, ARoundRobotTurnsAboutItsMiddle) {
  disc(0.03, -0.02, 0.165, 0.02, 0.09);
  const BasePrior prior = footprint_prior(vertices);
  DOUBLES_EQUAL(0.03, prior.x_m, 1e-3);
  DOUBLES_EQUAL(-0.02, prior.y_m, 1e-3);
  CHECK(prior.sigma_forward_m < 0.005);
}

TEST(Footprint, ABumperAndALaptopDoNotMoveIt) {
  disc(0.03, -0.02, 0.165, 0.02, 0.09);
  disc(0.03, -0.02, 0.175, 0.02, 0.09, -0.5, 0.5);
  box(0.06, 0.05, 0.34, 0.24, 0.4, 0.09, 0.30);
  const BasePrior prior = footprint_prior(vertices);
  DOUBLES_EQUAL(0.03, prior.x_m, 2.5e-3);
  DOUBLES_EQUAL(-0.02, prior.y_m, 2.5e-3);
}

TEST(Footprint, ABoxIsAlikeOnBothSidesButItsAxleMayBeAnywhere) {
  box(0.05, 0.02, 0.40, 0.25, 0.6, 0, 0.15);
  const BasePrior prior = footprint_prior(vertices);
  DOUBLES_EQUAL(0.05, prior.x_m, 1e-3);
  DOUBLES_EQUAL(0.02, prior.y_m, 1e-3);
  CHECK(prior.sigma_forward_m > 0.04);
  CHECK(prior.sigma_lateral_m < 0.01);
}

TEST(Footprint, HalfADiscIsNotTakenForARoundRobot) {
  disc(0, 0, 0.165, 0.02, 0.09, 0, kPi);
  CHECK(footprint_prior(vertices).sigma_forward_m > 0.03);
}

TEST(Footprint, AFewVerticesSayNothing) {
  add(1, 2, 3);
  const BasePrior prior = footprint_prior(vertices);
  DOUBLES_EQUAL(BasePrior{}.sigma_lateral_m, prior.sigma_lateral_m, 0);
  DOUBLES_EQUAL(0, prior.x_m, 0);
}
