#include "algo/volume/volume.hpp"

#include <cmath>
#include <cstring>

namespace st {
namespace {

constexpr std::size_t kPad = 16;  // elements behind the last voxel that wide loads may read
constexpr std::size_t kRow = kBrickSide;

// Calls row(index of the row's first voxel) for the 64 rows of a brick.
template <typename F>
void for_rows(const Volume& v, int bx, int by, int bz, F&& row) {
  for (int z = 0; z < kBrickSide; ++z)
    for (int y = 0; y < kBrickSide; ++y)
      row(v.index(bx * kBrickSide, by * kBrickSide + y, bz * kBrickSide + z));
}

void clear_brick(Volume& v, int bx, int by, int bz) {
  for_rows(v, bx, by, bz, [&v](std::size_t at) {
    for (std::size_t i = 0; i < kRow; ++i) v.tsdf[at + i] = kUnseen;
    std::memset(&v.weight[at], 0, kRow);
    std::memset(&v.observations[at], 0, kRow);
    std::memset(&v.color[at], 0, kRow * sizeof v.color[0]);
  });
  v.bricks[v.brick_index(bx, by, bz)] = 0;
  v.octants[v.brick_index(bx, by, bz)] = 0;
}

void copy_brick(Volume& v, const int (&from)[3], const int (&to)[3]) {
  const std::ptrdiff_t distance =
      static_cast<std::ptrdiff_t>(v.index(to[0] * kBrickSide, to[1] * kBrickSide, to[2] * kBrickSide)) -
      static_cast<std::ptrdiff_t>(v.index(from[0] * kBrickSide, from[1] * kBrickSide, from[2] * kBrickSide));
  for_rows(v, from[0], from[1], from[2], [&v, distance](std::size_t at) {
    const std::size_t there = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + distance);
    std::memcpy(&v.tsdf[there], &v.tsdf[at], kRow * sizeof v.tsdf[0]);
    std::memcpy(&v.weight[there], &v.weight[at], kRow);
    std::memcpy(&v.observations[there], &v.observations[at], kRow);
    std::memcpy(&v.color[there], &v.color[at], kRow * sizeof v.color[0]);
  });
  const std::size_t source = v.brick_index(from[0], from[1], from[2]),
                    target = v.brick_index(to[0], to[1], to[2]);
  v.bricks[target] = v.bricks[source];
  v.octants[target] = v.octants[source];
}

}  // namespace

void Volume::bind(Bump& memory, int voxels_a_side) {
  side = voxels_a_side;
  tsdf = memory.take<std::int16_t>(voxels() + kPad);
  weight = memory.take<std::uint8_t>(voxels() + kPad);
  observations = memory.take<std::uint8_t>(voxels() + kPad);
  color = memory.take<std::uint32_t>(voxels() + kPad);
  const std::size_t b = static_cast<std::size_t>(bricks_a_side());
  bricks = memory.take<std::uint8_t>(b * b * b);
  octants = memory.take<std::uint8_t>(b * b * b);
  if (!bricks.empty()) std::memset(bricks.data(), kBrickTouched, bricks.size());
}

void Volume::reset(float voxel, float truncation, const Vec3f& box_centre) {
  voxel_m = voxel;
  truncation_m = truncation;
  const float h = 0.5f * extent_m();
  origin = box_centre - Vec3f{h, h, h};
  integrations = 0;
  const int b = bricks_a_side();
  for (int z = 0; z < b; ++z)
    for (int y = 0; y < b; ++y)
      for (int x = 0; x < b; ++x)
        if (bricks[brick_index(x, y, z)] != 0) clear_brick(*this, x, y, z);
}

void recentre(Volume& v, const BrickShift& shift) {
  const int b = v.bricks_a_side();
  const int by[3] = {shift.x, shift.y, shift.z};
  const auto ordered = [b](int i, int s) {
    return s > 0 ? b - 1 - i : i;
  };  // sources are read before they are written
  for (int k = 0; k < b; ++k)
    for (int j = 0; j < b; ++j)
      for (int i = 0; i < b; ++i) {
        const int to[3] = {ordered(i, by[0]), ordered(j, by[1]), ordered(k, by[2])};
        const int from[3] = {to[0] - by[0], to[1] - by[1], to[2] - by[2]};
        bool inside = true;
        for (int f : from) inside = inside && f >= 0 && f < b;
        if (inside && v.bricks[v.brick_index(from[0], from[1], from[2])] != 0) {
          copy_brick(v, from, to);
        } else if (v.bricks[v.brick_index(to[0], to[1], to[2])] != 0) {
          clear_brick(v, to[0], to[1], to[2]);
        }
      }
  const float brick_m = v.voxel_m * static_cast<float>(kBrickSide);
  v.origin -=
      Vec3f{static_cast<float>(by[0]), static_cast<float>(by[1]), static_cast<float>(by[2])} * brick_m;
}

BrickShift shift_towards(const Volume& v, const Vec3f& wanted) {
  const Vec3f bricks = (v.centre() - wanted) * (1.0f / (v.voxel_m * static_cast<float>(kBrickSide)));
  const float limit = static_cast<float>(v.bricks_a_side());
  const auto whole = [limit](float f) {
    if (!(f > -limit)) return -static_cast<int>(limit);
    return static_cast<int>(std::floor((f < limit ? f : limit) + 0.5f));
  };
  return {whole(bricks.x), whole(bricks.y), whole(bricks.z)};
}

float choose_voxel_m(float extent_m, int voxels_a_side) {
  constexpr float kFilled = 0.6f, kFinest_m = 0.002f;
  const float voxel = extent_m / (kFilled * static_cast<float>(voxels_a_side));
  return voxel > kFinest_m ? voxel : kFinest_m;
}

float choose_truncation_m(float voxel_m, float depth_sigma_m) {
  const float wanted = 3.0f * depth_sigma_m, least = 4.0f * voxel_m, most = 10.0f * voxel_m;
  return wanted < least ? least : wanted > most ? most : wanted;
}

ColorSample sample_color(const Volume& v, const Vec3f& p) {
  const Vec3f q = (p - v.origin) * (1.0f / v.voxel_m);
  const float last = static_cast<float>(v.side - 1);
  if (!(q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < last && q.y < last && q.z < last)) return {};
  const int x = static_cast<int>(q.x), y = static_cast<int>(q.y), z = static_cast<int>(q.z);
  const float a = q.x - static_cast<float>(x), b = q.y - static_cast<float>(y),
              d = q.z - static_cast<float>(z);
  ColorSample o;
  float known = 0;
  for (int i = 0; i < 8; ++i) {
    const int dx = i & 1, dy = (i >> 1) & 1, dz = i >> 2;
    const std::uint32_t c = v.color[v.index(x + dx, y + dy, z + dz)];
    if (color_trust_of(c) == 0) continue;
    const float w = (dx != 0 ? a : 1 - a) * (dy != 0 ? b : 1 - b) * (dz != 0 ? d : 1 - d);
    known += w;
    o.r += w * static_cast<float>(red_of(c));
    o.g += w * static_cast<float>(green_of(c));
    o.b += w * static_cast<float>(blue_of(c));
  }
  if (known < 0.5f) return {};
  return {o.r / known, o.g / known, o.b / known, true};
}

}  // namespace st
