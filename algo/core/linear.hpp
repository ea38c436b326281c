// Plain 3-vectors and 3x3 matrices: trivially copyable, so that they may travel through rings and files as
// they are. The decompositions (which need Eigen) are in algo/core/solve.hpp.
#pragma once

#include <cmath>

namespace st {

template <typename T>
struct Vec3T {
  T x{}, y{}, z{};

  constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr Vec3T operator+(const Vec3T& b) const { return {x + b.x, y + b.y, z + b.z}; }
  constexpr Vec3T operator-(const Vec3T& b) const { return {x - b.x, y - b.y, z - b.z}; }
  constexpr Vec3T operator-() const { return {-x, -y, -z}; }
  constexpr Vec3T operator*(T s) const { return {x * s, y * s, z * s}; }
  constexpr Vec3T& operator+=(const Vec3T& b) { return *this = *this + b; }
  constexpr Vec3T& operator-=(const Vec3T& b) { return *this = *this - b; }
};

template <typename T>
constexpr T dot(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
constexpr Vec3T<T> cross(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
T norm(const Vec3T<T>& a) {
  return std::sqrt(dot(a, a));
}
// Unit vector along a; a itself when its length is zero.
template <typename T>
Vec3T<T> normalized(const Vec3T<T>& a) {
  const T n = norm(a);
  return n > T(0) ? a * (T(1) / n) : a;
}

using Vec3 = Vec3T<double>;
using Vec3f = Vec3T<float>;

constexpr Vec3f to_float(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
constexpr Vec3 to_double(const Vec3f& v) { return {v.x, v.y, v.z}; }

// Row-major 3x3.
template <typename T>
struct Mat3T {
  T m[9]{1, 0, 0, 0, 1, 0, 0, 0, 1};

  constexpr T operator()(int r, int c) const { return m[3 * r + c]; }
  constexpr T& operator()(int r, int c) { return m[3 * r + c]; }
  constexpr Vec3T<T> row(int r) const { return {m[3 * r], m[3 * r + 1], m[3 * r + 2]}; }
  constexpr Vec3T<T> col(int c) const { return {m[c], m[3 + c], m[6 + c]}; }
  constexpr Mat3T transposed() const { return {{m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}}; }
  constexpr Vec3T<T> operator*(const Vec3T<T>& v) const {
    return {dot(row(0), v), dot(row(1), v), dot(row(2), v)};
  }
  constexpr Mat3T operator*(const Mat3T& b) const {
    Mat3T o;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) o(r, c) = dot(row(r), b.col(c));
    return o;
  }
  static constexpr Mat3T from_columns(const Vec3T<T>& a, const Vec3T<T>& b, const Vec3T<T>& c) {
    return {{a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z}};
  }
};

using Mat3 = Mat3T<double>;
using Mat3f = Mat3T<float>;

constexpr Mat3f to_float(const Mat3& a) {
  Mat3f o;
  for (int i = 0; i < 9; ++i) o.m[i] = static_cast<float>(a.m[i]);
  return o;
}

}  // namespace st
