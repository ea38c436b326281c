// Triangle meshes as PLY: binary little-endian; vertex x y z nx ny nz (float), red green blue (uchar),
// observations (ushort); face list uchar int vertex_indices. Metres.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "algo/core/mesh.hpp"

namespace st {

std::string format_ply(const MeshView& mesh);

struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;
  MeshView view() const { return {vertices, indices}; }
};

// Reads back what format_ply() writes. Throws Failure (kBadInput) for any other layout and for cut or
// inconsistent files.
Mesh parse_ply(std::string_view bytes, const std::string& name);

}  // namespace st
