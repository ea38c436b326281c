// Meshes from other programs: PLY, ascii or binary little-endian, any properties; used are x y z, nx ny nz,
// red green blue (0-255) and faces of three corners and more.
#pragma once

#include <string>
#include <string_view>

#include "hal/results/ply_file.hpp"

namespace st {

// Normals that are missing are made from the faces. `scale`: metres per unit of the file. Throws Failure
// (kBadInput) for what is no such mesh, has no faces, or names vertices that are not there.
Mesh import_ply(std::string_view bytes, double scale, const std::string& name);

}  // namespace st
