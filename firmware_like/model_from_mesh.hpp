// A model from a mesh: of a scan, of a run, or from another program.
#pragma once

#include "algo/core/mesh.hpp"
#include "firmware_like/model_codec.hpp"

namespace st {

// The mesh in metres, z up, standing on z = 0. Throws Failure (kBadInput) when it is too small or too large
// to be an object (1 cm to 3 m). `name`: for the message.
OwnedModel model_from_mesh(const MeshView& mesh, const std::string& name);

// The model as a mesh, in its frame. On the heap, held by `meshes`.
class ModelMeshes;
MeshView mesh_of(const KnownModel& model, ModelMeshes& meshes);

}  // namespace st
