// Rigid motions SE(3) and SE(2). T_a_b takes coordinates in frame b to frame a: p_a = T_a_b * p_b.
#pragma once

#include "algo/core/linear.hpp"

namespace st {

struct Pose {
  Mat3 R{};
  Vec3 t{};

  Vec3 operator*(const Vec3& p) const { return R * p + t; }
  Pose operator*(const Pose& b) const { return {R * b.R, R * b.t + t}; }
  Pose inverse() const {
    const Mat3 Rt = R.transposed();
    return {Rt, -(Rt * t)};
  }
};

// Float copy for per-pixel work.
struct PoseF {
  Mat3f R{};
  Vec3f t{};

  Vec3f operator*(const Vec3f& p) const { return R * p + t; }
};
constexpr PoseF to_float(const Pose& T) { return {to_float(T.R), to_float(T.t)}; }

// Small motion (translation, rotation vector), in that order everywhere: gradients, covariances, files.
struct Twist {
  Vec3 v{};
  Vec3 w{};
};

// Unit quaternion, x y z w as in TUM files.
struct Quaternion {
  double x{}, y{}, z{}, w{1};
};

// Planar pose on the floor; yaw counter-clockwise seen from above.
struct Pose2 {
  double x{}, y{}, yaw{};
};

Mat3 rotation_from_vector(const Vec3& rotation_rad);  // Rodrigues
Vec3 rotation_to_vector(const Mat3& R);               // angle in [0, pi]
double rotation_angle(const Mat3& R);
Mat3 rotation_z(double yaw_rad);
Mat3 orthonormalized(
    const Mat3& R);  // nearest by Gram-Schmidt; call it after every update so that error does not grow

// T with the small motion applied on the left, about the point `pivot` (frame a): p' = exp(w) (T p - pivot) +
// pivot + v.
Pose moved_about(const Pose& T, const Twist& step, const Vec3& pivot);

Quaternion to_quaternion(const Mat3& R);    // w >= 0
Mat3 from_quaternion(const Quaternion& q);  // normalises

// Roll, pitch, yaw with R = Rz(yaw) Ry(pitch) Rx(roll).
Vec3 to_roll_pitch_yaw(const Mat3& R);
Mat3 from_roll_pitch_yaw(const Vec3& rpy);

Pose2 compose(const Pose2& a, const Pose2& b);
Pose2 inverse(const Pose2& a);
// Share f of the way from a to b, turning the shorter way round.
Pose2 between(const Pose2& a, const Pose2& b, double f);

}  // namespace st
