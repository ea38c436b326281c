// A non-owning view of a row-major image without padding. Pixel (u, v): u to the right, v down, centres at
// whole numbers.
#pragma once

#include <cstddef>

namespace st {

template <typename T>
struct ImageView {
  T* data = nullptr;
  int width = 0;
  int height = 0;

  constexpr T& operator()(int u, int v) const { return data[v * width + u]; }
  constexpr T* row(int v) const { return data + static_cast<std::ptrdiff_t>(v) * width; }
  constexpr int pixels() const { return width * height; }
  constexpr bool empty() const { return data == nullptr || pixels() == 0; }
  constexpr bool contains(int u, int v) const { return u >= 0 && v >= 0 && u < width && v < height; }
  constexpr operator ImageView<const T>() const { return {data, width, height}; }
};

// Half-open pixel rectangle [u0, u1) x [v0, v1).
struct Rect {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;

  constexpr int width() const { return u1 > u0 ? u1 - u0 : 0; }
  constexpr int height() const { return v1 > v0 ? v1 - v0 : 0; }
  constexpr bool empty() const { return width() == 0 || height() == 0; }
  constexpr Rect clipped(int w, int h) const {
    return {u0 < 0 ? 0 : u0, v0 < 0 ? 0 : v0, u1 > w ? w : u1, v1 > h ? h : v1};
  }
  constexpr Rect grown(int by) const { return {u0 - by, v0 - by, u1 + by, v1 + by}; }
  constexpr void include(int u, int v) {
    if (u < u0) u0 = u;
    if (v < v0) v0 = v;
    if (u + 1 > u1) u1 = u + 1;
    if (v + 1 > v1) v1 = v + 1;
  }
  constexpr void include(const Rect& other) {
    if (other.empty()) return;
    include(other.u0, other.v0);
    include(other.u1 - 1, other.v1 - 1);
  }
  // The empty rectangle that include() can start from.
  static constexpr Rect nothing() { return {1 << 30, 1 << 30, -(1 << 30), -(1 << 30)}; }
};

// Share of the box that lies inside of an image.
constexpr double share_inside(const Rect& box, int width, int height) {
  const double area = static_cast<double>(box.width()) * box.height();
  const Rect in = box.clipped(width, height);
  return area > 0 ? static_cast<double>(in.width()) * in.height() / area : 0.0;
}

constexpr bool overlap(const Rect& a, const Rect& b) {
  return a.u0 < b.u1 && b.u0 < a.u1 && a.v0 < b.v1 && b.v0 < a.v1;
}

}  // namespace st
