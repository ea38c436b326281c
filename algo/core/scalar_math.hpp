// Elementary functions that give the same bits on every machine. glibc picks variants of sin, atan2 and exp
// by CPU features, which would make a pose depend on the PC it was computed on; these use only + - * / and
// sqrt. Absolute error below 1e-13 over the stated ranges (tests/algo/core/scalar_math_test.cpp).
#pragma once

#include <cmath>

namespace st {

inline constexpr double kPi = 3.14159265358979323846;

struct SinCos {
  double sin, cos;
};

SinCos sin_cos(double angle_rad);     // |angle| up to 1e6 rad
double arc_tan2(double y, double x);  // (-pi, pi]; 0 for (0, 0)
double exponential(double x);         // clamps to [exp(-700), exp(700)]
double natural_log(double x);         // x > 0

// The angle in (-pi, pi].
double wrap_angle(double angle_rad);

}  // namespace st
