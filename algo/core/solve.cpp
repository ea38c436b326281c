#include "algo/core/solve.hpp"

#include <cmath>
#include <utility>

namespace st {
namespace {

// Lower Cholesky factor of A in L, row-major n x n. False when a pivot vanishes beside the largest one: a
// direction that nobody measured.
bool factor(const double* A, int n, double* L) {
  double largest = 0;
  for (int i = 0; i < n; ++i) largest = A[i * n + i] > largest ? A[i * n + i] : largest;
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c <= r; ++c) {
      double sum = A[r * n + c];
      for (int k = 0; k < c; ++k) sum -= L[r * n + k] * L[c * n + k];
      if (r != c) {
        L[r * n + c] = sum / L[c * n + c];
      } else {
        if (!(sum > 1e-13 * largest)) return false;
        L[r * n + r] = std::sqrt(sum);
      }
    }
  }
  return true;
}

void substitute(const double* L, int n, double* x) {
  for (int r = 0; r < n; ++r) {
    for (int k = 0; k < r; ++k) x[r] -= L[r * n + k] * x[k];
    x[r] /= L[r * n + r];
  }
  for (int r = n - 1; r >= 0; --r) {
    for (int k = r + 1; k < n; ++k) x[r] -= L[k * n + r] * x[k];
    x[r] /= L[r * n + r];
  }
}

}  // namespace

bool solve_spd(const double* A, const double* b, double* x, int n) {
  double L[kMaxUnknowns * kMaxUnknowns];
  if (!factor(A, n, L)) return false;
  for (int i = 0; i < n; ++i) x[i] = b[i];
  substitute(L, n, x);
  return true;
}

bool invert_spd(const double* A, double* inverse, int n) {
  double L[kMaxUnknowns * kMaxUnknowns];
  if (!factor(A, n, L)) return false;
  for (int c = 0; c < n; ++c) {
    double column[kMaxUnknowns]{};
    column[c] = 1.0;
    substitute(L, n, column);
    for (int r = 0; r < n; ++r) inverse[r * n + c] = column[r];
  }
  return true;
}

void eigen_symmetric(const double* A, double* values, double* vectors, int n) {
  double a[kMaxUnknowns * kMaxUnknowns];
  for (int i = 0; i < n * n; ++i) a[i] = A[i];
  for (int i = 0; i < n * n; ++i) vectors[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
  constexpr int kSweeps = 16;  // converges quadratically; 8x8 needs about 8
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int p = 0; p < n; ++p) {
      for (int q = p + 1; q < n; ++q) {
        const double off = a[p * n + q];
        if (off == 0.0) continue;
        const double theta = (a[q * n + q] - a[p * n + p]) / (2.0 * off);
        const double t = (theta >= 0 ? 1.0 : -1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1.0));
        const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
        for (int k = 0; k < n; ++k) {
          const double kp = a[k * n + p], kq = a[k * n + q];
          a[k * n + p] = c * kp - s * kq;
          a[k * n + q] = s * kp + c * kq;
        }
        for (int k = 0; k < n; ++k) {
          const double pk = a[p * n + k], qk = a[q * n + k];
          a[p * n + k] = c * pk - s * qk;
          a[q * n + k] = s * pk + c * qk;
          const double vp = vectors[k * n + p], vq = vectors[k * n + q];
          vectors[k * n + p] = c * vp - s * vq;
          vectors[k * n + q] = s * vp + c * vq;
        }
      }
    }
  }
  for (int i = 0; i < n; ++i) values[i] = a[i * n + i];
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (values[j] >= values[i]) continue;
      std::swap(values[i], values[j]);
      for (int k = 0; k < n; ++k) std::swap(vectors[k * n + i], vectors[k * n + j]);
    }
  }
}

}  // namespace st
