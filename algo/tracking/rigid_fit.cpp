#include "algo/tracking/rigid_fit.hpp"

#include "algo/core/solve.hpp"

namespace st {

void RigidFit::add(const Vec3& from, const Vec3& to) {
  ++pairs_;
  from_ += from;
  to_ += to;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) cross_[3 * r + c] += from[r] * to[c];
}

bool RigidFit::solve(Pose& motion) const {
  if (pairs_ < 3) return false;
  const double n = pairs_;
  const Vec3 from = from_ * (1 / n), to = to_ * (1 / n);
  double S[9];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) S[3 * r + c] = cross_[3 * r + c] / n - from[r] * to[c];
  // Horn's symmetric matrix; its eigenvector of the largest eigenvalue is the turn as w, x, y, z.
  const double N[16] = {S[0] + S[4] + S[8], S[5] - S[7],        S[6] - S[2],         S[1] - S[3],
                        S[5] - S[7],        S[0] - S[4] - S[8], S[1] + S[3],         S[6] + S[2],
                        S[6] - S[2],        S[1] + S[3],        -S[0] + S[4] - S[8], S[5] + S[7],
                        S[1] - S[3],        S[6] + S[2],        S[5] + S[7],         -S[0] - S[4] + S[8]};
  double values[4], vectors[16];
  eigen_symmetric(N, values, vectors, 4);
  motion.R = from_quaternion({vectors[7], vectors[11], vectors[15], vectors[3]});
  motion.t = to - motion.R * from;
  return true;
}

}  // namespace st
