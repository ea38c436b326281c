// Pictures of a stored model.
#pragma once

#include <span>
#include <string>

#include "algo/core/mesh.hpp"
#include "algo/recognition/sift3d.hpp"

namespace st {

// 128 pixels square, PNG. Empty when the mesh is.
std::string model_thumbnail(const MeshView& mesh);

// From above and obliquely, with a ring where each keypoint is, as large as its scale. PNG.
std::string model_picture(const MeshView& mesh, std::span<const Feature> features);

}  // namespace st
