#include "algo/volume/fill_from_mesh.hpp"

#include <cmath>

namespace st {
namespace {

constexpr std::uint8_t kSeenOften = 100, kObservations = 50;
constexpr std::uint8_t kSureColor = 0xF2;  // full trust, spread of nine grey levels

// Barycentric coordinates of the triangle's point nearest to p (Ericson, Real-Time Collision
// Detection, 5.1.5).
Vec3f nearest_on_triangle(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3f ab = b - a, ac = c - a, ap = p - a;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3f bp = p - b;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const Vec3f cp = p - c;
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const float sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};
  return {va / sum, vb / sum, vc / sum};
}

std::uint8_t blend(std::uint8_t a, std::uint8_t b, std::uint8_t c, const Vec3f& w) {
  return static_cast<std::uint8_t>(static_cast<float>(a) * w.x + static_cast<float>(b) * w.y +
                                   static_cast<float>(c) * w.z + 0.5f);
}

void mark(Volume& v, int x, int y, int z, bool inside) {
  const std::size_t brick = v.brick_index(x / kBrickSide, y / kBrickSide, z / kBrickSide);
  v.bricks[brick] = static_cast<std::uint8_t>(v.bricks[brick] | kBrickTouched | (inside ? kBrickSolid : 0));
  constexpr int kPart = kBrickSide / 2;
  const int part = x % kBrickSide / kPart + 2 * (y % kBrickSide / kPart) + 4 * (z % kBrickSide / kPart);
  if (inside) v.octants[brick] = static_cast<std::uint8_t>(v.octants[brick] | 1 << part);
}

struct Box {
  int low[3], high[3];
};

// The voxels within `reach` of the triangle's box.
Box box_around(const Volume& v, const Vec3f (&corners)[3], float reach) {
  Box box{};
  for (int axis = 0; axis < 3; ++axis) {
    float low = corners[0][axis], high = low;
    for (const Vec3f& corner : corners) {
      low = corner[axis] < low ? corner[axis] : low;
      high = corner[axis] > high ? corner[axis] : high;
    }
    const float last = static_cast<float>(v.side - 1);
    const float from = std::ceil((low - reach - v.origin[axis]) / v.voxel_m);
    const float to = std::floor((high + reach - v.origin[axis]) / v.voxel_m);
    box.low[axis] = static_cast<int>(from < 0 ? 0 : from > last ? last : from);
    box.high[axis] = static_cast<int>(to < 0 ? 0 : to > last ? last : to);
  }
  return box;
}

bool has_colors(const MeshView& mesh) {
  for (const MeshVertex& vertex : mesh.vertices)
    if (vertex.r != 0 || vertex.g != 0 || vertex.b != 0) return true;
  return false;
}

}  // namespace

void fill_from_mesh(const MeshView& mesh, Volume& v) {
  const std::uint8_t color_state = has_colors(mesh) ? kSureColor : 0;
  // As long as it is being filled, `weight` says how squarely a voxel faces its triangle; 0: none reached it.
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const MeshVertex* const corner[3] = {&mesh.vertices[mesh.indices[i]], &mesh.vertices[mesh.indices[i + 1]],
                                         &mesh.vertices[mesh.indices[i + 2]]};
    const Vec3f at[3] = {corner[0]->position, corner[1]->position, corner[2]->position};
    const Vec3f flat = cross(at[1] - at[0], at[2] - at[0]);
    const Box box = box_around(v, at, v.truncation_m);
    for (int z = box.low[2]; z <= box.high[2]; ++z)
      for (int y = box.low[1]; y <= box.high[1]; ++y)
        for (int x = box.low[0]; x <= box.high[0]; ++x) {
          const Vec3f p = v.position(x, y, z);
          const Vec3f w = nearest_on_triangle(p, at[0], at[1], at[2]);
          const Vec3f away = p - (at[0] * w.x + at[1] * w.y + at[2] * w.z);
          const float distance = norm(away);
          if (distance >= v.truncation_m) continue;
          Vec3f normal = corner[0]->normal * w.x + corner[1]->normal * w.y + corner[2]->normal * w.z;
          if (!(dot(normal, normal) > 0)) normal = flat;
          const float towards = dot(away, normal);
          const bool inside = towards < 0;
          const std::size_t voxel = v.index(x, y, z);
          const float scaled = distance / v.truncation_m * kTsdfScale;
          const int magnitude = static_cast<int>(scaled < 32766.0f ? scaled : 32766.0f);
          // Beside an edge both its triangles are as near; the one that the voxel faces knows its side.
          const float length = distance * norm(normal);
          const int facing = length > 0 ? static_cast<int>(254 * std::fabs(towards) / length) + 1 : 1;
          const int before = v.tsdf[voxel] < 0 ? -v.tsdf[voxel] : v.tsdf[voxel];
          constexpr int kAsNear = 2;
          if (v.weight[voxel] != 0 && magnitude > before - kAsNear &&
              (magnitude > before + kAsNear || facing <= v.weight[voxel]))
            continue;
          v.tsdf[voxel] = static_cast<std::int16_t>(inside ? -magnitude : magnitude);
          v.weight[voxel] = static_cast<std::uint8_t>(facing > 255 ? 255 : facing);
          v.observations[voxel] = kObservations;
          v.color[voxel] = pack_rgb(blend(corner[0]->r, corner[1]->r, corner[2]->r, w),
                                    blend(corner[0]->g, corner[1]->g, corner[2]->g, w),
                                    blend(corner[0]->b, corner[1]->b, corner[2]->b, w), color_state);
          mark(v, x, y, z, inside);
        }
  }
  for (std::uint8_t& weight : v.weight.first(v.voxels()))
    if (weight != 0) weight = kSeenOften;
}

}  // namespace st
