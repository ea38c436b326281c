#include "algo/core/solve.hpp"

#include <CppUTest/TestHarness.h>

using namespace st;

TEST_GROUP(Solve) {
  // A = M M^T + I of a fixed M: positive definite, full.
  double A[36];
  void setup() override {
    double M[36];
    for (int i = 0; i < 36; ++i) M[i] = ((i * 7919) % 101) / 50.0 - 1.0;
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) {
        A[6 * r + c] = r == c ? 1.0 : 0.0;
        for (int k = 0; k < 6; ++k) A[6 * r + c] += M[6 * r + k] * M[6 * c + k];
      }
  }
};

TEST(Solve, SolutionSatisfiesTheSystem) {
  const double b[6] = {1, -2, 3, 0.5, 0, 4};
  double x[6];
  CHECK(solve_spd(A, b, x, 6));
  for (int r = 0; r < 6; ++r) {
    double sum = 0;
    for (int c = 0; c < 6; ++c) sum += A[6 * r + c] * x[c];
    DOUBLES_EQUAL(b[r], sum, 1e-12);
  }
}

TEST(Solve, InverseTimesMatrixIsIdentity) {
  double inverse[36];
  CHECK(invert_spd(A, inverse, 6));
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) {
      double sum = 0;
      for (int k = 0; k < 6; ++k) sum += A[6 * r + k] * inverse[6 * k + c];
      DOUBLES_EQUAL(r == c ? 1.0 : 0.0, sum, 1e-12);
    }
}

TEST(Solve, SingularSystemIsRefused) {
  double S[4] = {1, 1, 1, 1}, b[2] = {1, 1}, x[2] = {7, 7};
  CHECK_FALSE(solve_spd(S, b, x, 2));
  DOUBLES_EQUAL(7, x[0], 0);
}

TEST(Solve, EigenvectorsDiagonaliseInAscendingOrder) {
  double values[6], vectors[36];
  eigen_symmetric(A, values, vectors, 6);
  for (int i = 0; i < 6; ++i) {
    if (i > 0) CHECK(values[i] >= values[i - 1]);
    for (int r = 0; r < 6; ++r) {
      double sum = 0;
      for (int c = 0; c < 6; ++c) sum += A[6 * r + c] * vectors[6 * c + i];
      DOUBLES_EQUAL(values[i] * vectors[6 * r + i], sum, 1e-11);
    }
  }
}
