// Small symmetric systems on the caller's arrays. Eigen's own solvers of this size call the heap or libm's
// acos.
#pragma once

namespace st {

inline constexpr int kMaxUnknowns = 8;

// Solves the symmetric positive definite system A x = b; A row-major n x n, n <= kMaxUnknowns. False (x
// untouched) when A is not positive definite to working precision.
bool solve_spd(const double* A, const double* b, double* x, int n);

// Inverse of a symmetric positive definite matrix, row-major n x n. False when it is not.
bool invert_spd(const double* A, double* inverse, int n);

// Eigenvalues (ascending) and unit eigenvectors (columns, row-major n x n) of a symmetric matrix, n <=
// kMaxUnknowns, by cyclic Jacobi rotations: Eigen's own solvers call libm's acos or the heap.
void eigen_symmetric(const double* A, double* values, double* vectors, int n);

}  // namespace st
