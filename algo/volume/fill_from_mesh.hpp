// A mesh as a volume: the exact signed distance to its triangles, so that a model from a file serves as well
// as one that was seen. For use before or after the loop.
#pragma once

#include "algo/core/mesh.hpp"
#include "algo/volume/volume.hpp"

namespace st {

// Into a volume that was just reset(). Inside is where the vertex normals point away from, taken at the
// nearest triangle's nearest point; colours are interpolated there. Every voxel within the truncation counts
// as seen often. Triangles need not close a surface. A mesh that is black all over has no colours.
void fill_from_mesh(const MeshView& mesh, Volume& volume);

}  // namespace st
