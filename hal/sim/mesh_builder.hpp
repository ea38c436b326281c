// Puts meshes together from boxes, bodies of revolution and polygons. Metres, z up.
#pragma once

#include <span>

#include "algo/core/pose.hpp"
#include "hal/sim/surface.hpp"

namespace st::sim {

struct Point2 {
  float x = 0, y = 0;
};

class MeshBuilder {
 public:
  std::uint32_t material(const Material& m);
  std::uint32_t material(const Paint& paint) { return material(Material{paint, nullptr}); }

  // Four corners counter-clockwise seen from outside; u runs from a to b, v from a to d, in metres.
  void quad(Vec3f a, Vec3f b, Vec3f c, Vec3f d, std::uint32_t material);
  // The rectangle at `origin` spanned by u and v, cut into cells of about cell_m: light is interpolated
  // between vertices.
  void grid(Vec3f origin, Vec3f u, Vec3f v, float cell_m, std::uint32_t material);
  void box(Vec3f low, Vec3f high, std::uint32_t material);
  // The profile's points (x: radius, y: height), ordered so that the outside lies to the right of the way up,
  // turned from angle `from` to `to` about the z axis through `centre`. u is the angle times the first
  // radius, v the height.
  void lathe(std::span<const Point2> profile, float from_rad, float to_rad, int segments,
             std::uint32_t material, Point2 centre = {});
  // Flat polygon (simple, counter-clockwise) at height z, seen from above or from below; u, v are x, y plus
  // half the period, so that a texture's middle lies at the origin.
  void polygon(std::span<const Point2> outline, float z, bool up, std::uint32_t material,
               float uv_offset_m = 0);
  // Walls over a counter-clockwise outline, from low to high; facing out, or in (a pit).
  void walls(std::span<const Point2> outline, float low, float high, bool inwards, std::uint32_t material);
  // An upright tube with closed ends between two points.
  void tube(Vec3f from, Vec3f to, float radius_from, float radius_to, int segments, std::uint32_t material);

  void append(const Mesh& other, const Pose& T_this_other);
  Mesh take() { return std::move(mesh_); }

 private:
  std::uint32_t vertex(Vec3f position, Vec3f normal, float u, float v);

  Mesh mesh_;
};

// Circle arc from one angle to another, ends included.
std::vector<Point2> arc(Point2 centre, float radius, float from_rad, float to_rad, int segments);

}  // namespace st::sim
