// One set of normal equations in which all pose information meets. Unknowns, in this order: the small motion
// of the object (translation m, rotation rad, camera axes, about the object's pivot) and the shift of the
// colour image against the depth image (pixels), which absorbs registration error. Minimises sum of w (r + J
// x)^2, so x = -H^-1 g.
#pragma once

#include <cmath>

#include "algo/core/linear.hpp"

namespace st {

struct NormalEquations {
  static constexpr int kPose = 6;
  static constexpr int kSize = 8;

  double H[kSize * kSize]{};  // only the upper triangle is kept; mirrored() completes it
  double g[kSize]{};

  // A residual that depends on the pose alone.
  void add(const double (&J)[kPose], double r, double w) {
    for (int i = 0; i < kPose; ++i) {
      const double wJ = w * J[i];
      g[i] += wJ * r;
      for (int j = i; j < kPose; ++j) H[i * kSize + j] += wJ * J[j];
    }
  }

  // A unit direction known to be `up` stands at `leaning`: it leans by w x up, which two level axes a, b (a x
  // b = up) measure.
  void add_lean(const Vec3& up, const Vec3& leaning, double sigma_rad) {
    const Vec3 helper = std::fabs(up.x) < 0.8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 a = normalized(cross(helper, up)), b = cross(up, a);
    const Vec3 lean = leaning - up;
    const double w = 1.0 / (sigma_rad * sigma_rad);
    const double Ja[6] = {0, 0, 0, b.x, b.y, b.z};
    const double Jb[6] = {0, 0, 0, -a.x, -a.y, -a.z};
    add(Ja, dot(lean, a), w);
    add(Jb, dot(lean, b), w);
  }

  // Sums of a kernel over its first n unknowns: upper triangle of w J J^T row by row, and w J r.
  void add_sums(const double* triangle, const double* gradient, int n) {
    for (int i = 0; i < n; ++i) {
      g[i] += gradient[i];
      for (int j = i; j < n; ++j) H[i * kSize + j] += *triangle++;
    }
  }

  void add(const NormalEquations& other) {
    for (int i = 0; i < kSize * kSize; ++i) H[i] += other.H[i];
    for (int i = 0; i < kSize; ++i) g[i] += other.g[i];
  }

  // The pose's part of H, both triangles.
  void copy_pose_block(double (&pose)[36]) const {
    for (int i = 0; i < kPose; ++i)
      for (int j = 0; j < kPose; ++j) pose[kPose * i + j] = H[i < j ? kSize * i + j : kSize * j + i];
  }

  void mirror() {
    for (int i = 0; i < kSize; ++i)
      for (int j = 0; j < i; ++j) H[i * kSize + j] = H[j * kSize + i];
  }
};

}  // namespace st
