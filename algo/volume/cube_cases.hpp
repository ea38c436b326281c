// The 256 cases of marching cubes, derived at compile time instead of copied. On each face of the cube every
// run of inside corners is cut off by one segment: the neighbour across the face decides the same, so meshes
// have no cracks, also where a face is ambiguous. The segments join to loops around the cube, and each loop
// is cut into a fan whose diagonals lie in no face, so that every edge of the mesh belongs to two triangles.
#pragma once

#include <cstdint>

namespace st {

// Corner i of a cell stands at (i & 1, i >> 1 & 1, i >> 2). Edge 3 * axis + k runs along `axis` from the k-th
// of the four corners, in rising order, that lie at 0 on that axis.
struct CubeEdge {
  int from, axis;
};
constexpr CubeEdge cube_edge(int e) {
  const int axis = e / 4, k = e % 4;
  const int low = axis == 0 ? 2 : 1, high = axis == 2 ? 2 : 4;
  return {(k & 1) * low + (k >> 1) * high, axis};
}
constexpr int cube_edge_between(int a, int b) {
  const int from = a < b ? a : b, axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  for (int k = 0; k < 4; ++k)
    if (cube_edge(4 * axis + k).from == from) return 4 * axis + k;
  return -1;
}

struct CubeCase {
  std::uint8_t triangles = 0;
  std::uint8_t edges[15] = {};
};

namespace cube_detail {

// Corners of face f (axis f / 2, side f % 2), counter-clockwise seen from outside the cell.
constexpr int face_corner(int f, int i) {
  const int axis = f / 2, side = f % 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const int k = side == 1 ? i & 3 : 3 - (i & 3);
  return (side << axis) | ((k == 1 || k == 2) ? 1 << u : 0) | ((k == 2 || k == 3) ? 1 << v : 0);
}

constexpr bool share_face(int edge_a, int edge_b) {
  for (int f = 0; f < 6; ++f) {
    bool a = false, b = false;
    for (int i = 0; i < 4; ++i) {
      const int e = cube_edge_between(face_corner(f, i), face_corner(f, i + 1));
      a = a || e == edge_a;
      b = b || e == edge_b;
    }
    if (a && b) return true;
  }
  return false;
}

constexpr bool fan_stays_inside(const int (&loop)[12], int n, int apex) {
  for (int j = 2; j < n - 1; ++j)
    if (share_face(loop[apex], loop[(apex + j) % n])) return false;
  return true;
}

// Successor of each cut edge around its loop, clockwise seen from outside the solid; -1 for edges that are
// not cut.
struct Successors {
  int next[12];
};
constexpr Successors successors(int corners_inside) {
  Successors s{};
  for (int& n : s.next) n = -1;
  for (int f = 0; f < 6; ++f) {
    const auto inside = [&](int i) { return ((corners_inside >> face_corner(f, i)) & 1) != 0; };
    for (int i = 0; i < 4; ++i) {
      if (inside(i + 3) || !inside(i)) continue;
      int last = i;
      while (inside(last + 1)) ++last;
      s.next[cube_edge_between(face_corner(f, last), face_corner(f, last + 1))] =
          cube_edge_between(face_corner(f, i + 3), face_corner(f, i));
    }
  }
  return s;
}

constexpr CubeCase make_case(int corners_inside) {
  Successors s = successors(corners_inside);
  CubeCase out;
  for (int start = 0; start < 12; ++start) {
    int loop[12] = {}, n = 0;
    for (int e = start; s.next[e] >= 0;) {
      loop[n++] = e;
      const int following = s.next[e];
      s.next[e] = -1;
      e = following;
    }
    int apex = 0;
    while (n > 0 && apex < n && !fan_stays_inside(loop, n, apex)) ++apex;
    for (int j = 1; j + 1 < n; ++j) {
      out.edges[3 * out.triangles] = static_cast<std::uint8_t>(loop[apex % n]);
      out.edges[3 * out.triangles + 1] = static_cast<std::uint8_t>(loop[(apex + j + 1) % n]);
      out.edges[3 * out.triangles + 2] = static_cast<std::uint8_t>(loop[(apex + j) % n]);
      ++out.triangles;
    }
  }
  return out;
}

struct CubeCases {
  CubeCase of[256];
};
constexpr CubeCases make_cases() {
  CubeCases all{};
  for (int i = 0; i < 256; ++i) all.of[i] = make_case(i);
  return all;
}

}  // namespace cube_detail

// By the corners' bits: set where the corner is inside the solid.
inline constexpr cube_detail::CubeCases kCubeCases = cube_detail::make_cases();

}  // namespace st
