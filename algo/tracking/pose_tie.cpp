#include "algo/tracking/pose_tie.hpp"

#include "algo/core/solve.hpp"

namespace st {
namespace {

constexpr int kN = NormalEquations::kSize, kPose = NormalEquations::kPose;

// The pose's unknowns turned by R.
void turn_axes(const Mat3& R, NormalEquations& eq) {
  const auto turn = [&](double* at, int stride) {
    for (int block = 0; block < kPose; block += 3) {
      double* v = at + block * stride;
      const Vec3 turned = R * Vec3{v[0], v[stride], v[2 * stride]};
      for (int i = 0; i < 3; ++i) v[i * stride] = turned[i];
    }
  };
  for (int i = 0; i < kN; ++i) turn(&eq.H[kN * i], 1);
  for (int i = 0; i < kN; ++i) turn(&eq.H[i], kN);
  turn(eq.g, 1);
}

Vec3 carried(const Mat3& R, const double* share, const double* e, const Vec3& camera) {
  const Vec3 v = R * camera;
  return R.transposed() * Vec3{share[0] * v.x + e[0], share[1] * v.y + e[1], share[2] * v.z + e[2]};
}

}  // namespace

// A (share d + e) = -g with e = S u, u ~ N(0, I), S diagonal: u is eliminated (Schur complement of I + S A
// S), which holds for S = 0, too.
TieRest add_tied(const NormalEquations& eq, const PoseTie& tie, NormalEquations& into) {
  NormalEquations A = eq;
  A.mirror();
  turn_axes(tie.R_frame_camera, A);
  const double* S = tie.sigma;
  double inner[kPose * kPose], inverse[kPose * kPose];
  for (int i = 0; i < kPose; ++i)
    for (int j = 0; j < kPose; ++j)
      inner[kPose * i + j] = S[i] * A.H[kN * i + j] * S[j] + (i == j ? 1.0 : 0.0);
  TieRest rest;
  if (!invert_spd(inner, inverse, kPose)) return rest;
  rest.told = true;

  double gain[kPose * kPose];  // covariance of e once the pose sought is known
  for (int i = 0; i < kPose; ++i)
    for (int j = 0; j < kPose; ++j) gain[kPose * i + j] = S[i] * inverse[kPose * i + j] * S[j];
  for (int i = 0; i < kPose; ++i) {
    rest.variance[i] = gain[kPose * i + i];
    for (int j = 0; j < kPose; ++j) {
      rest.mean[i] -= gain[kPose * i + j] * A.g[j];
      rest.slope[i] -= gain[kPose * i + j] * A.H[kN * j + i] * tie.share[i];
    }
  }
  NormalEquations left = A;
  for (int i = 0; i < kN; ++i) {
    for (int k = 0; k < kPose; ++k) {
      double Ag = 0;
      for (int j = 0; j < kPose; ++j) Ag += A.H[kN * i + j] * gain[kPose * j + k];
      left.g[i] -= Ag * A.g[k];
      for (int j = 0; j < kN; ++j) left.H[kN * i + j] -= Ag * A.H[kN * k + j];
    }
  }
  for (int i = 0; i < kPose; ++i) {
    left.g[i] *= tie.share[i];
    for (int j = 0; j < kN; ++j) left.H[kN * i + j] *= tie.share[i];
    for (int j = 0; j < kN; ++j) left.H[kN * j + i] *= tie.share[i];
  }
  turn_axes(tie.R_frame_camera.transposed(), left);
  for (int i = 0; i < kN; ++i) {
    into.g[i] += left.g[i];
    for (int j = i; j < kN; ++j) into.H[kN * i + j] += left.H[kN * i + j];
  }
  return rest;
}

Twist tied_deviation(const PoseTie& tie, const Twist& deviation, const double (&e)[6]) {
  return {carried(tie.R_frame_camera, tie.share, e, deviation.v),
          carried(tie.R_frame_camera, tie.share + 3, e + 3, deviation.w)};
}

}  // namespace st
