#include "algo/tracking/pose_tie.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <random>

#include "algo/core/solve.hpp"

using namespace st;

namespace {

constexpr int kN = NormalEquations::kSize;

// Random equations of full rank, upper triangle only.
NormalEquations some_equations(std::mt19937& random) {
  std::normal_distribution<double> any;
  NormalEquations eq;
  for (int n = 0; n < 30; ++n) {
    double J[kN];
    for (double& j : J) j = any(random);
    const double r = any(random);
    for (int i = 0; i < kN; ++i) {
      eq.g[i] += J[i] * r;
      for (int j = i; j < kN; ++j) eq.H[kN * i + j] += J[i] * J[j];
    }
  }
  return eq;
}

// The same minimum found with the errors as unknowns of their own, by alternating exact solves.
struct Joint {
  double x[kN]{}, e[6]{};
};
Joint solve_jointly(const NormalEquations& full, const PoseTie& tie) {
  Joint s;
  for (int round = 0; round < 4000; ++round) {
    // other = T^T (share * (T d)) + T^T e, T the turn into the tie's frame; here T = 1.
    double y[kN];
    const auto other = [&] {
      for (int i = 0; i < kN; ++i) y[i] = i < 6 ? tie.share[i] * s.x[i] + s.e[i] : s.x[i];
    };
    for (int i = 0; i < kN + 6; ++i) {  // one coordinate after the other
      other();
      const int k = i < kN ? i : i - kN;
      double slope = full.g[k], curve = full.H[kN * k + k];
      for (int j = 0; j < kN; ++j) slope += full.H[kN * k + j] * y[j];
      if (i < kN) {
        const double share = k < 6 ? tie.share[k] : 1.0;
        s.x[k] -= share * slope / (share * share * curve);
      } else {
        const double prior = 1 / (tie.sigma[k] * tie.sigma[k]);
        s.e[k] -= (slope + prior * s.e[k]) / (curve + prior);
      }
    }
  }
  return s;
}

}  // namespace

TEST_GROUP(PoseTie) { std::mt19937 random{3}; };

TEST(PoseTie, NothingOpenChangesNothing) {
  const NormalEquations eq = some_equations(random);
  PoseTie tie;
  tie.R_frame_camera = rotation_from_vector({0.4, -0.7, 0.2});
  NormalEquations out;
  const TieRest rest = add_tied(eq, tie, out);
  for (int i = 0; i < kN; ++i) {
    DOUBLES_EQUAL(eq.g[i], out.g[i], 1e-9);
    for (int j = i; j < kN; ++j) DOUBLES_EQUAL(eq.H[kN * i + j], out.H[kN * i + j], 1e-9);
  }
  for (int i = 0; i < 6; ++i) DOUBLES_EQUAL(0, rest.variance[i], 0);
}

TEST(PoseTie, TheSolutionIsThatOfAllUnknownsTogether) {
  NormalEquations eq = some_equations(random);
  PoseTie tie;
  const double share[6] = {0.9, 0.6, 1.0, 0.8, 0.5, 1.1}, sigma[6] = {0.4, 0.2, 0.3, 0.1, 0.5, 0.3};
  for (int i = 0; i < 6; ++i) tie.share[i] = share[i], tie.sigma[i] = sigma[i];
  NormalEquations out;
  add_tied(eq, tie, out);
  out.mirror();
  double b[kN], x[kN];
  for (int i = 0; i < kN; ++i) b[i] = -out.g[i];
  CHECK(solve_spd(out.H, b, x, kN));
  eq.mirror();
  const Joint joint = solve_jointly(eq, tie);
  for (int i = 0; i < kN; ++i) DOUBLES_EQUAL(joint.x[i], x[i], 1e-6);

  // Taken at the solution, the rest is the error of the joint one.
  NormalEquations there = eq;
  for (int i = 0; i < kN; ++i)
    for (int j = 0; j < kN; ++j) there.g[i] += eq.H[kN * i + j] * (j < 6 ? share[j] * x[j] : x[j]);
  NormalEquations ignored;
  const TieRest rest = add_tied(there, tie, ignored);
  for (int i = 0; i < 6; ++i) {
    DOUBLES_EQUAL(joint.e[i], rest.mean[i], 1e-6);
    CHECK(rest.variance[i] > 0 && rest.variance[i] < sigma[i] * sigma[i]);
  }
}

TEST(PoseTie, AnErrorWithoutBoundsLeavesNothingToSay) {
  const NormalEquations eq = some_equations(random);
  PoseTie tie;
  tie.R_frame_camera = rotation_from_vector({0.1, 0.9, -0.3});
  tie.sigma[5] = 1e5;  // the turn about the frame's z axis
  NormalEquations out;
  add_tied(eq, tie, out);
  out.mirror();
  const Vec3 axis = tie.R_frame_camera.transposed() * Vec3{0, 0, 1};
  double along = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) along += axis[i] * out.H[kN * (3 + i) + 3 + j] * axis[j];
  DOUBLES_EQUAL(0, along, 1e-4);
  CHECK(out.H[0] > 1);
}

TEST(PoseTie, DeviationsAreSharedInTheFramesAxes) {
  PoseTie tie;
  tie.R_frame_camera = rotation_from_vector({0.3, 0.2, 0.1});
  tie.share[1] = 0.5;
  const double e[6] = {0, 0.01, 0, 0, 0, 0.02};
  const Mat3 back = tie.R_frame_camera.transposed();
  const Twist then = tied_deviation(tie, {back * Vec3{1, 2, 3}, back * Vec3{0, 0, 0.1}}, e);
  DOUBLES_EQUAL(0, norm(then.v - back * Vec3{1, 1.01, 3}), 1e-12);
  DOUBLES_EQUAL(0, norm(then.w - back * Vec3{0, 0, 0.12}), 1e-12);
}
