#include "hal/sim/mesh_builder.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st::sim {
namespace {

float cross2(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

bool inside(Point2 p, Point2 a, Point2 b, Point2 c) {
  return cross2(a, b, p) > 0 && cross2(b, c, p) > 0 && cross2(c, a, p) > 0;
}

bool is_ear(std::span<const Point2> p, const std::vector<std::uint32_t>& ring, std::size_t k) {
  const std::size_t n = ring.size();
  const Point2 a = p[ring[(k + n - 1) % n]], b = p[ring[k]], c = p[ring[(k + 1) % n]];
  if (cross2(a, b, c) <= 0) return false;
  return std::none_of(ring.begin(), ring.end(), [&](std::uint32_t i) { return inside(p[i], a, b, c); });
}

SinCos at_angle(float rad) { return sin_cos(rad); }

}  // namespace

std::uint32_t MeshBuilder::material(const Material& m) {
  mesh_.materials.push_back(m);
  return static_cast<std::uint32_t>(mesh_.materials.size() - 1);
}

std::uint32_t MeshBuilder::vertex(Vec3f position, Vec3f normal, float u, float v) {
  mesh_.vertices.push_back({position, normal, u, v});
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshBuilder::quad(Vec3f a, Vec3f b, Vec3f c, Vec3f d, std::uint32_t material) {
  const Vec3f n = normalized(cross(b - a, d - a));
  const float w = norm(b - a), h = norm(d - a);
  const std::uint32_t i = vertex(a, n, 0, 0);
  vertex(b, n, w, 0);
  vertex(c, n, w, h);
  vertex(d, n, 0, h);
  mesh_.faces.push_back({i, i + 1, i + 2, material});
  mesh_.faces.push_back({i, i + 2, i + 3, material});
}

void MeshBuilder::grid(Vec3f origin, Vec3f u, Vec3f v, float cell_m, std::uint32_t material) {
  const Vec3f n = normalized(cross(u, v));
  const float w = norm(u), h = norm(v);
  const int nu = std::max(1, static_cast<int>(w / cell_m)), nv = std::max(1, static_cast<int>(h / cell_m));
  const std::uint32_t first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(nu),
                  t = static_cast<float>(j) / static_cast<float>(nv);
      vertex(origin + u * s + v * t, n, w * s, h * t);
    }
  const std::uint32_t row = static_cast<std::uint32_t>(nu + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(nv); ++j)
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t k = first + j * row + i;
      mesh_.faces.push_back({k, k + 1, k + row + 1, material});
      mesh_.faces.push_back({k, k + row + 1, k + row, material});
    }
}

void MeshBuilder::box(Vec3f l, Vec3f h, std::uint32_t material) {
  quad({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z}, material);  // top
  quad({l.x, h.y, l.z}, {h.x, h.y, l.z}, {h.x, l.y, l.z}, {l.x, l.y, l.z}, material);  // bottom
  quad({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z}, material);  // -y
  quad({h.x, h.y, l.z}, {l.x, h.y, l.z}, {l.x, h.y, h.z}, {h.x, h.y, h.z}, material);  // +y
  quad({h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}, {h.x, l.y, h.z}, material);  // +x
  quad({l.x, h.y, l.z}, {l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, material);  // -x
}

void MeshBuilder::lathe(std::span<const Point2> profile, float from_rad, float to_rad, int segments,
                        std::uint32_t material, Point2 centre) {
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const Point2 a = profile[k], b = profile[k + 1];
    const Vec3f slope =
        normalized(Vec3f{b.y - a.y, 0, a.x - b.x});  // outwards, in the plane of radius and height
    const std::uint32_t first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (int i = 0; i <= segments; ++i) {
      const float angle =
          from_rad + (to_rad - from_rad) * static_cast<float>(i) / static_cast<float>(segments);
      const SinCos sc = at_angle(angle);
      const float c = static_cast<float>(sc.cos), s = static_cast<float>(sc.sin);
      const Vec3f n{slope.x * c, slope.x * s, slope.z};
      vertex({centre.x + a.x * c, centre.y + a.x * s, a.y}, n, angle * profile[0].x, a.y);
      vertex({centre.x + b.x * c, centre.y + b.x * s, b.y}, n, angle * profile[0].x, b.y);
    }
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(segments); ++i) {
      const std::uint32_t v = first + 2 * i;
      mesh_.faces.push_back({v, v + 2, v + 3, material});
      mesh_.faces.push_back({v, v + 3, v + 1, material});
    }
  }
}

void MeshBuilder::polygon(std::span<const Point2> outline, float z, bool up, std::uint32_t material,
                          float uv_offset_m) {
  const Vec3f n{0, 0, up ? 1.0f : -1.0f};
  const std::uint32_t first = static_cast<std::uint32_t>(mesh_.vertices.size());
  std::vector<std::uint32_t> ring;
  for (std::uint32_t i = 0; i < outline.size(); ++i) {
    vertex({outline[i].x, outline[i].y, z}, n, outline[i].x + uv_offset_m, outline[i].y + uv_offset_m);
    ring.push_back(i);
  }
  while (ring.size() > 2) {
    std::size_t k = 0;
    while (k + 1 < ring.size() && !is_ear(outline, ring, k)) ++k;
    const std::size_t m = ring.size();
    const std::uint32_t a = first + ring[(k + m - 1) % m], b = first + ring[k], c = first + ring[(k + 1) % m];
    mesh_.faces.push_back(up ? Face{a, b, c, material} : Face{a, c, b, material});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

void MeshBuilder::walls(std::span<const Point2> outline, float low, float high, bool inwards,
                        std::uint32_t material) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    Point2 a = outline[i], b = outline[(i + 1) % outline.size()];
    if (inwards) std::swap(a, b);
    quad({a.x, a.y, low}, {b.x, b.y, low}, {b.x, b.y, high}, {a.x, a.y, high}, material);
  }
}

void MeshBuilder::tube(Vec3f from, Vec3f to, float radius_from, float radius_to, int segments,
                       std::uint32_t material) {
  MeshBuilder straight;
  const std::uint32_t m = straight.material(Paint{});
  const float length = norm(to - from);
  const Point2 profile[] = {{0, 0}, {radius_from, 0}, {radius_to, length}, {0, length}};
  straight.lathe(profile, 0, static_cast<float>(2 * kPi), segments, m);
  const Vec3 z = normalized(to_double(to - from));
  const Vec3 side = std::fabs(z.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 y = normalized(cross(z, side));
  const Mesh mesh = straight.take();
  const std::size_t faces_before = mesh_.faces.size();
  append(mesh, {Mat3::from_columns(cross(y, z), y, z), to_double(from)});
  mesh_.materials.pop_back();
  for (std::size_t i = faces_before; i < mesh_.faces.size(); ++i) mesh_.faces[i].material = material;
}

void MeshBuilder::append(const Mesh& other, const Pose& T_this_other) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh_.vertices.size());
  const std::uint32_t first_material = static_cast<std::uint32_t>(mesh_.materials.size());
  const PoseF T = to_float(T_this_other);
  for (Vertex v : other.vertices) {
    v.position = T * v.position;
    v.normal = T.R * v.normal;
    mesh_.vertices.push_back(v);
  }
  for (const Face& f : other.faces)
    mesh_.faces.push_back({first + f.a, first + f.b, first + f.c, first_material + f.material});
  mesh_.materials.insert(mesh_.materials.end(), other.materials.begin(), other.materials.end());
}

std::vector<Point2> arc(Point2 centre, float radius, float from_rad, float to_rad, int segments) {
  std::vector<Point2> points;
  for (int i = 0; i <= segments; ++i) {
    const SinCos sc =
        sin_cos(from_rad + (to_rad - from_rad) * static_cast<float>(i) / static_cast<float>(segments));
    points.push_back(
        {centre.x + radius * static_cast<float>(sc.cos), centre.y + radius * static_cast<float>(sc.sin)});
  }
  return points;
}

}  // namespace st::sim
