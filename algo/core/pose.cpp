#include "algo/core/pose.hpp"

#include "algo/core/scalar_math.hpp"

namespace st {

Mat3 rotation_from_vector(const Vec3& r) {
  const double angle = norm(r);
  // sin(a)/a and (1-cos(a))/a^2, by series where the quotient would lose digits.
  double a, b;
  if (angle < 1e-4) {
    a = 1.0 - angle * angle / 6.0;
    b = 0.5 - angle * angle / 24.0;
  } else {
    const SinCos sc = sin_cos(angle);
    a = sc.sin / angle;
    b = (1.0 - sc.cos) / (angle * angle);
  }
  Mat3 o;
  o(0, 0) = 1 - b * (r.y * r.y + r.z * r.z);
  o(0, 1) = b * r.x * r.y - a * r.z;
  o(0, 2) = b * r.x * r.z + a * r.y;
  o(1, 0) = b * r.x * r.y + a * r.z;
  o(1, 1) = 1 - b * (r.x * r.x + r.z * r.z);
  o(1, 2) = b * r.y * r.z - a * r.x;
  o(2, 0) = b * r.x * r.z - a * r.y;
  o(2, 1) = b * r.y * r.z + a * r.x;
  o(2, 2) = 1 - b * (r.x * r.x + r.y * r.y);
  return o;
}

Vec3 rotation_to_vector(const Mat3& R) {
  const Quaternion q = to_quaternion(R);
  const Vec3 v{q.x, q.y, q.z};
  const double s = norm(v);
  if (s < 1e-12) return v * 2.0;
  return v * (2.0 * arc_tan2(s, q.w) / s);
}

double rotation_angle(const Mat3& R) { return norm(rotation_to_vector(R)); }

Mat3 rotation_z(double yaw_rad) {
  const SinCos sc = sin_cos(yaw_rad);
  return {{sc.cos, -sc.sin, 0, sc.sin, sc.cos, 0, 0, 0, 1}};
}

Mat3 orthonormalized(const Mat3& R) {
  const Vec3 x = normalized(R.col(0));
  const Vec3 y = normalized(R.col(1) - x * dot(x, R.col(1)));
  return Mat3::from_columns(x, y, cross(x, y));
}

Pose moved_about(const Pose& T, const Twist& step, const Vec3& pivot) {
  const Mat3 dR = rotation_from_vector(step.w);
  return {orthonormalized(dR * T.R), dR * (T.t - pivot) + pivot + step.v};
}

Quaternion to_quaternion(const Mat3& R) {
  const double trace = R(0, 0) + R(1, 1) + R(2, 2);
  Quaternion q;
  if (trace > 0) {
    const double s = std::sqrt(trace + 1.0) * 2.0;
    q = {(R(2, 1) - R(1, 2)) / s, (R(0, 2) - R(2, 0)) / s, (R(1, 0) - R(0, 1)) / s, 0.25 * s};
  } else if (R(0, 0) > R(1, 1) && R(0, 0) > R(2, 2)) {
    const double s = std::sqrt(1.0 + R(0, 0) - R(1, 1) - R(2, 2)) * 2.0;
    q = {0.25 * s, (R(0, 1) + R(1, 0)) / s, (R(0, 2) + R(2, 0)) / s, (R(2, 1) - R(1, 2)) / s};
  } else if (R(1, 1) > R(2, 2)) {
    const double s = std::sqrt(1.0 + R(1, 1) - R(0, 0) - R(2, 2)) * 2.0;
    q = {(R(0, 1) + R(1, 0)) / s, 0.25 * s, (R(1, 2) + R(2, 1)) / s, (R(0, 2) - R(2, 0)) / s};
  } else {
    const double s = std::sqrt(1.0 + R(2, 2) - R(0, 0) - R(1, 1)) * 2.0;
    q = {(R(0, 2) + R(2, 0)) / s, (R(1, 2) + R(2, 1)) / s, 0.25 * s, (R(1, 0) - R(0, 1)) / s};
  }
  if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
  return q;
}

Mat3 from_quaternion(const Quaternion& q) {
  const double n2 = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const double s = n2 > 0 ? 2.0 / n2 : 0.0;
  Mat3 o;
  o(0, 0) = 1 - s * (q.y * q.y + q.z * q.z);
  o(0, 1) = s * (q.x * q.y - q.z * q.w);
  o(0, 2) = s * (q.x * q.z + q.y * q.w);
  o(1, 0) = s * (q.x * q.y + q.z * q.w);
  o(1, 1) = 1 - s * (q.x * q.x + q.z * q.z);
  o(1, 2) = s * (q.y * q.z - q.x * q.w);
  o(2, 0) = s * (q.x * q.z - q.y * q.w);
  o(2, 1) = s * (q.y * q.z + q.x * q.w);
  o(2, 2) = 1 - s * (q.x * q.x + q.y * q.y);
  return o;
}

Vec3 to_roll_pitch_yaw(const Mat3& R) {
  const double cos_pitch = std::sqrt(R(0, 0) * R(0, 0) + R(1, 0) * R(1, 0));
  const double pitch = arc_tan2(-R(2, 0), cos_pitch);
  if (cos_pitch < 1e-9)
    return {0.0, pitch, arc_tan2(-R(0, 1), R(1, 1))};  // gimbal lock: roll is taken as zero
  return {arc_tan2(R(2, 1), R(2, 2)), pitch, arc_tan2(R(1, 0), R(0, 0))};
}

Mat3 from_roll_pitch_yaw(const Vec3& rpy) {
  return rotation_z(rpy.z) * rotation_from_vector({0, rpy.y, 0}) * rotation_from_vector({rpy.x, 0, 0});
}

Pose2 compose(const Pose2& a, const Pose2& b) {
  const SinCos sc = sin_cos(a.yaw);
  return {a.x + sc.cos * b.x - sc.sin * b.y, a.y + sc.sin * b.x + sc.cos * b.y, wrap_angle(a.yaw + b.yaw)};
}

Pose2 inverse(const Pose2& a) {
  const SinCos sc = sin_cos(a.yaw);
  return {-(sc.cos * a.x + sc.sin * a.y), sc.sin * a.x - sc.cos * a.y, -a.yaw};
}

Pose2 between(const Pose2& a, const Pose2& b, double f) {
  return {a.x + (b.x - a.x) * f, a.y + (b.y - a.y) * f, wrap_angle(a.yaw + wrap_angle(b.yaw - a.yaw) * f)};
}

}  // namespace st
