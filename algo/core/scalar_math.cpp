#include "algo/core/scalar_math.hpp"

#include <cstdint>
#include <cstring>

namespace st {
namespace {

// Taylor series on |x| <= pi/4; the last term kept is below 1e-17.
double sin_kernel(double x) {
  const double x2 = x * x;
  double term = x, sum = x;
  for (int n = 1; n <= 9; ++n) {
    term *= -x2 / static_cast<double>((2 * n) * (2 * n + 1));
    sum += term;
  }
  return sum;
}

double cos_kernel(double x) {
  const double x2 = x * x;
  double term = 1.0, sum = 1.0;
  for (int n = 1; n <= 9; ++n) {
    term *= -x2 / static_cast<double>((2 * n - 1) * (2 * n));
    sum += term;
  }
  return sum;
}

// atan on [0, 1]: two half-angle reductions bring the argument below 0.2, where the series converges fast.
double atan_unit(double x) {
  for (int i = 0; i < 2; ++i) x = x / (1.0 + std::sqrt(1.0 + x * x));
  const double x2 = x * x;
  double power = x, sum = x;
  for (int n = 1; n <= 12; ++n) {
    power *= -x2;
    sum += power / static_cast<double>(2 * n + 1);
  }
  return 4.0 * sum;
}

}  // namespace

SinCos sin_cos(double angle_rad) {
  // pi/2 in two parts keeps the reduction exact for the angles that occur here.
  constexpr double kHalfPiHigh = 1.57079632673412561417, kHalfPiLow = 6.07710050650619224932e-11;
  const double quarter = std::floor(angle_rad * (2.0 / kPi) + 0.5);
  const double x = (angle_rad - quarter * kHalfPiHigh) - quarter * kHalfPiLow;
  const double s = sin_kernel(x), c = cos_kernel(x);
  switch (static_cast<std::int64_t>(quarter) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double arc_tan2(double y, double x) {
  if (x == 0.0 && y == 0.0) return 0.0;
  const double ax = std::fabs(x), ay = std::fabs(y);
  double a = ax >= ay ? atan_unit(ay / ax) : kPi / 2 - atan_unit(ax / ay);
  if (x < 0.0) a = kPi - a;
  return y < 0.0 ? -a : a;
}

double exponential(double x) {
  if (x > 700.0) x = 700.0;
  if (x < -700.0) x = -700.0;
  constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  const double k = std::floor(x / 0.693147180559945309417 + 0.5);
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double term = 1.0, sum = 1.0;
  for (int n = 1; n <= 14; ++n) {
    term *= r / static_cast<double>(n);
    sum += term;
  }
  const std::uint64_t bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + 1023) << 52;
  double scale;
  std::memcpy(&scale, &bits, sizeof scale);
  return sum * scale;
}

double natural_log(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::int64_t exponent = static_cast<std::int64_t>((bits >> 52) & 0x7ff) - 1023;
  bits = (bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL;
  double mantissa;
  std::memcpy(&mantissa, &bits, sizeof mantissa);
  // log m = 2 atanh((m - 1) / (m + 1)), with m in [1, 2).
  const double t = (mantissa - 1.0) / (mantissa + 1.0), t2 = t * t;
  double power = t, sum = t;
  for (int n = 1; n <= 16; ++n) {
    power *= t2;
    sum += power / static_cast<double>(2 * n + 1);
  }
  return 2.0 * sum + static_cast<double>(exponent) * 0.693147180559945309417;
}

double wrap_angle(double angle_rad) {
  const double turns = std::ceil((angle_rad - kPi) / (2.0 * kPi));
  const double a = angle_rad - turns * 2.0 * kPi;
  return a <= -kPi || a > kPi ? kPi : a;  // rounding may land beyond either end
}

}  // namespace st
