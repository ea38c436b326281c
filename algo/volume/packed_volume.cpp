#include "algo/volume/packed_volume.hpp"

#include <cstring>

namespace st {
namespace {

// Calls row(index of the row's first voxel in the volume, in the brick) for the 64 rows of a brick.
template <typename F>
void for_rows(const Volume& v, int bx, int by, int bz, const F& row) {
  for (int z = 0; z < kBrickSide; ++z)
    for (int y = 0; y < kBrickSide; ++y)
      row(v.index(bx * kBrickSide, by * kBrickSide + y, bz * kBrickSide + z),
          static_cast<std::size_t>((z * kBrickSide + y) * kBrickSide));
}

// Whether some voxel knows how far the surface is; the others only say that it is not there.
bool is_near_surface(const Volume& v, int bx, int by, int bz) {
  if (v.bricks[v.brick_index(bx, by, bz)] == 0) return false;
  bool near = false;
  for_rows(v, bx, by, bz, [&](std::size_t at, std::size_t) {
    for (std::size_t i = at; i < at + kBrickSide; ++i)
      near = near || (v.tsdf[i] != kUnseen && v.tsdf[i] < 32767 && v.tsdf[i] > -32767);
  });
  return near;
}

template <typename F>
void for_bricks(const Volume& v, const F& visit) {
  const int b = v.bricks_a_side();
  for (int z = 0; z < b; ++z)
    for (int y = 0; y < b; ++y)
      for (int x = 0; x < b; ++x)
        if (is_near_surface(v, x, y, z)) visit(x, y, z);
}

}  // namespace

std::size_t count_packed(const Volume& volume) {
  std::size_t count = 0;
  for_bricks(volume, [&](int, int, int) { ++count; });
  return count;
}

PackedVolume pack(const Volume& v, std::span<PackedBrick> bricks) {
  std::size_t used = 0;
  for_bricks(v, [&](int x, int y, int z) {
    PackedBrick& brick = bricks[used++];
    brick.x = static_cast<std::uint16_t>(x);
    brick.y = static_cast<std::uint16_t>(y);
    brick.z = static_cast<std::uint16_t>(z);
    brick.flags = v.bricks[v.brick_index(x, y, z)];
    brick.octants = v.octants[v.brick_index(x, y, z)];
    for_rows(v, x, y, z, [&](std::size_t at, std::size_t to) {
      std::memcpy(&brick.tsdf[to], &v.tsdf[at], kBrickSide * sizeof v.tsdf[0]);
      std::memcpy(&brick.weight[to], &v.weight[at], kBrickSide);
      std::memcpy(&brick.observations[to], &v.observations[at], kBrickSide);
      std::memcpy(&brick.color[to], &v.color[at], kBrickSide * sizeof v.color[0]);
    });
  });
  return {v.side, v.voxel_m, v.truncation_m, v.origin, v.integrations, bricks.first(used)};
}

bool unpack(const PackedVolume& packed, Volume& v) {
  const int shift = (v.side - packed.side) / 2 / kBrickSide;
  v.reset(packed.voxel_m, packed.truncation_m, {});
  const float moved = static_cast<float>(shift * kBrickSide) * packed.voxel_m;
  v.origin = packed.origin - Vec3f{moved, moved, moved};
  const int b = v.bricks_a_side();
  for (const PackedBrick& brick : packed.bricks)
    for (const int place : {brick.x + shift, brick.y + shift, brick.z + shift})
      if (place < 0 || place >= b) return false;
  v.integrations = packed.integrations;
  for (const PackedBrick& brick : packed.bricks) {
    const int x = brick.x + shift, y = brick.y + shift, z = brick.z + shift;
    v.bricks[v.brick_index(x, y, z)] = brick.flags;
    v.octants[v.brick_index(x, y, z)] = brick.octants;
    for_rows(v, x, y, z, [&](std::size_t at, std::size_t from) {
      std::memcpy(&v.tsdf[at], &brick.tsdf[from], kBrickSide * sizeof v.tsdf[0]);
      std::memcpy(&v.weight[at], &brick.weight[from], kBrickSide);
      std::memcpy(&v.observations[at], &brick.observations[from], kBrickSide);
      std::memcpy(&v.color[at], &brick.color[from], kBrickSide * sizeof v.color[0]);
    });
  }
  return true;
}

}  // namespace st
