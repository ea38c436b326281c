// A volume without its empty bricks, to keep many models in little memory: those bricks that a surface or its
// surroundings touch, some 4 MB for a floor robot.
#pragma once

#include <span>

#include "algo/volume/volume.hpp"

namespace st {

inline constexpr int kBrickVoxels = kBrickSide * kBrickSide * kBrickSide;

struct PackedBrick {
  std::uint16_t x = 0, y = 0, z = 0;  // in bricks
  std::uint8_t flags = 0, octants = 0;
  std::int16_t tsdf[kBrickVoxels]{};  // x fastest, then y, then z
  std::uint8_t weight[kBrickVoxels]{};
  std::uint8_t observations[kBrickVoxels]{};
  std::uint32_t color[kBrickVoxels]{};
};

struct PackedVolume {
  int side = 0;
  float voxel_m = 0, truncation_m = 0;
  Vec3f origin{};
  std::uint32_t integrations = 0;
  std::span<const PackedBrick> bricks;
};

// Bricks that pack() would write.
std::size_t count_packed(const Volume& volume);

// Fills `bricks`, which must hold count_packed(volume) of them, and describes them.
PackedVolume pack(const Volume& volume, std::span<PackedBrick> bricks);

// Replaces the content of `volume`, whose number of voxels a side may be another: then the bricks keep their
// place about the middle. False, and an empty volume, when some brick falls outside. No heap.
bool unpack(const PackedVolume& packed, Volume& volume);

}  // namespace st
