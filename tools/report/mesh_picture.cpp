#include "tools/report/mesh_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr int kOversampling = 3;

ViewDirection looking_from(double yaw_rad, double elevation_rad) {
  const SinCos a = sin_cos(yaw_rad), e = sin_cos(elevation_rad);
  const Vec3 towards{e.cos * a.cos, e.cos * a.sin, e.sin};
  const Vec3 right{-a.sin, a.cos, 0};
  const Vec3 up = cross(towards, right);
  return {Mat3::from_columns(right, up, towards).transposed()};
}

struct Shaded {
  double x, y, depth;
  Vec3 colour;
};

// Raster in oversampled pixels with a depth buffer.
class Raster {
 public:
  explicit Raster(int side)
      : side_(side), depth_(pixels(), -std::numeric_limits<double>::infinity()), colour_(pixels()) {}

  void triangle(const Shaded& a, const Shaded& b, const Shaded& c) {
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (!(std::fabs(area) > 1e-12)) return;
    const int u0 = clip(std::floor(std::min({a.x, b.x, c.x}))),
              u1 = clip(std::ceil(std::max({a.x, b.x, c.x})));
    const int v0 = clip(std::floor(std::min({a.y, b.y, c.y}))),
              v1 = clip(std::ceil(std::max({a.y, b.y, c.y})));
    for (int v = v0; v <= v1; ++v)
      for (int u = u0; u <= u1; ++u) {
        const double wb = ((u - a.x) * (c.y - a.y) - (v - a.y) * (c.x - a.x)) / area;
        const double wc = ((b.x - a.x) * (v - a.y) - (b.y - a.y) * (u - a.x)) / area;
        const double wa = 1 - wb - wc;
        constexpr double kEdge = -1e-9;
        if (wa < kEdge || wb < kEdge || wc < kEdge) continue;
        const double depth = wa * a.depth + wb * b.depth + wc * c.depth;
        const std::size_t at =
            static_cast<std::size_t>(v) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(u);
        if (depth <= depth_[at]) continue;
        depth_[at] = depth;
        colour_[at] = a.colour * wa + b.colour * wb + c.colour * wc;
      }
  }

  RgbaImage reduced(int by) const {
    RgbaImage image{side_ / by, side_ / by, {}};
    for (int v = 0; v < image.height; ++v)
      for (int u = 0; u < image.width; ++u) append_pixel(u * by, v * by, by, image.pixels);
    return image;
  }

 private:
  std::size_t pixels() const { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }
  int clip(double v) const { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(side_ - 1))); }

  void append_pixel(int u0, int v0, int by, std::vector<std::uint8_t>& out) const {
    Vec3 sum{};
    int covered = 0;
    for (int v = v0; v < v0 + by; ++v)
      for (int u = u0; u < u0 + by; ++u) {
        const std::size_t at =
            static_cast<std::size_t>(v) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(u);
        if (!std::isfinite(depth_[at])) continue;
        sum += colour_[at];
        ++covered;
      }
    for (int i = 0; i < 3; ++i)
      out.push_back(covered > 0 ? static_cast<std::uint8_t>(std::clamp(sum[i] / covered + 0.5, 0.0, 255.0))
                                : std::uint8_t{0});
    out.push_back(static_cast<std::uint8_t>(255 * covered / (by * by)));
  }

  int side_;
  std::vector<double> depth_;
  std::vector<Vec3> colour_;
};

// Half-Lambert from above the viewer's left shoulder: the colours stay readable on every side.
Vec3 shaded_colour(const MeshVertex& vertex, const Mat3& R) {
  const Vec3 light = normalized(Vec3{-0.45, 0.6, 0.9});
  const Vec3 n = R * to_double(vertex.normal);
  const double length = norm(n);
  const double half = length > 0 ? 0.5 + 0.5 * dot(n, light) / length : 0.75;
  const double shade = 0.42 + 0.62 * half;
  return Vec3{static_cast<double>(vertex.r), static_cast<double>(vertex.g), static_cast<double>(vertex.b)} *
         shade;
}

}  // namespace

ViewDirection view_from_above(double forward) { return looking_from(forward + kPi, 0.5 * kPi); }
ViewDirection view_from_front(double forward) { return looking_from(forward, 0); }
ViewDirection view_oblique(double forward) { return looking_from(forward + 0.65, 0.55); }
ViewDirection view_of_scene() { return {{{1, 0, 0, 0, -1, 0, 0, 0, -1}}}; }

MeshFrame frame_of(const MeshView& mesh) {
  MeshFrame frame;
  if (mesh.vertices.empty()) return frame;
  Vec3 low = to_double(mesh.vertices.front().position), high = low;
  for (const MeshVertex& vertex : mesh.vertices)
    for (int i = 0; i < 3; ++i) {
      const double value = static_cast<double>(vertex.position[i]);
      low[i] = std::min(low[i], value), high[i] = std::max(high[i], value);
    }
  frame.middle = (low + high) * 0.5;
  for (const MeshVertex& vertex : mesh.vertices)
    frame.radius_m = std::max(frame.radius_m, norm(to_double(vertex.position) - frame.middle));
  return frame;
}

RgbaImage render_mesh(const MeshView& mesh, const MeshFrame& frame, const ViewDirection& view, int pixels) {
  const int side = pixels * kOversampling;
  Raster raster(side);
  constexpr double kMargin = 1.03;
  const double scale = 0.5 * side / std::max(1e-9, frame.radius_m * kMargin);
  std::vector<Shaded> shaded(mesh.vertices.size());
  for (std::size_t i = 0; i < shaded.size(); ++i) {
    const Vec3 p = view.R * (to_double(mesh.vertices[i].position) - frame.middle);
    shaded[i] = {0.5 * side + p.x * scale, 0.5 * side - p.y * scale, p.z,
                 shaded_colour(mesh.vertices[i], view.R)};
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    raster.triangle(shaded[mesh.indices[i]], shaded[mesh.indices[i + 1]], shaded[mesh.indices[i + 2]]);
  return raster.reduced(kOversampling);
}

}  // namespace st
