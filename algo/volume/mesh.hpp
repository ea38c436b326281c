// The zero level as triangles (marching cubes, Lorensen & Cline 1987, with faces resolved the same way from
// both sides, so that no cracks open). For use after the loop: its cost grows with the volume, not with a
// frame.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/mesh.hpp"
#include "algo/volume/volume.hpp"

namespace st {

struct MeshOptions {
  int least_observations = 2;  // all eight voxels of a cell were seen by so many frames
};

struct MeshCounts {
  std::size_t vertices = 0, triangles = 0;
  std::size_t refused_triangles = 0;  // found no room in the caller's memory
};

struct MeshScratch {
  // For volumes up to this many voxels a side.
  void bind(Bump& memory, int max_side);
  std::span<std::uint32_t> edges;  // vertex of each cut grid edge of the present and the next slice
  std::span<std::uint8_t> wanted;  // bricks whose cells can hold surface
};

// How much memory extract_mesh() will fill.
MeshCounts count_mesh(const Volume& volume, const MeshOptions& options, MeshScratch& scratch);

// Vertices are shared between triangles; `indices` holds three a triangle, counter-clockwise from outside. A
// triangle that does not fit is left out and counted. Same volume, same mesh.
MeshCounts extract_mesh(const Volume& volume, const MeshOptions& options, MeshScratch& scratch,
                        std::span<MeshVertex> vertices, std::span<std::uint32_t> indices);

// Takes out connected pieces of fewer than `least_triangles` triangles (floaters that noise left) in place,
// keeping the order of the rest. `scratch` holds two numbers per vertex. Returns what remains.
MeshCounts remove_fragments(std::span<MeshVertex> vertices, std::span<std::uint32_t> indices,
                            std::size_t least_triangles, std::span<std::uint32_t> scratch);

}  // namespace st
