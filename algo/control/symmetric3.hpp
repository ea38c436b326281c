// Normal equations in three unknowns.
#pragma once

#include <cmath>

namespace st {

struct Symmetric3 {
  double m[3][3]{};

  void add_outer(const double (&j)[3], double weight) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) m[r][c] += weight * j[r] * j[c];
  }

  // Inverse by cofactors; false when it is singular.
  bool invert(Symmetric3& out) const {
    const auto minor = [this](int r0, int r1, int c0, int c1) {
      return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
    };
    const double c00 = minor(1, 2, 1, 2), c01 = -minor(1, 2, 0, 2), c02 = minor(1, 2, 0, 1);
    const double determinant = m[0][0] * c00 + m[0][1] * c01 + m[0][2] * c02;
    if (!(std::fabs(determinant) > 1e-300)) return false;
    const double s = 1.0 / determinant;
    out.m[0][0] = c00 * s, out.m[0][1] = out.m[1][0] = c01 * s, out.m[0][2] = out.m[2][0] = c02 * s;
    out.m[1][1] = minor(0, 2, 0, 2) * s, out.m[1][2] = out.m[2][1] = -minor(0, 2, 0, 1) * s;
    out.m[2][2] = minor(0, 1, 0, 1) * s;
    return true;
  }

  // x with m x = b; false when it is singular.
  bool solve(const double (&b)[3], double (&x)[3]) const {
    Symmetric3 inverse;
    if (!invert(inverse)) return false;
    for (int r = 0; r < 3; ++r)
      x[r] = inverse.m[r][0] * b[0] + inverse.m[r][1] * b[1] + inverse.m[r][2] * b[2];
    return true;
  }
};

}  // namespace st
