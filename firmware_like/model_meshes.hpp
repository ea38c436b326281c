// The objects' models as meshes, after the loop: memory from the heap, kept until the files are written.
#pragma once

#include <deque>
#include <vector>

#include "algo/core/pose.hpp"
#include "algo/volume/mesh.hpp"

namespace st {

class ModelMeshes {
 public:
  // In the frame that T_mesh_volume leads to. The view holds as long as this object. Pieces of fewer than 50
  // triangles are noise and left out.
  MeshView extract(const Volume& volume, const Pose& T_mesh_volume = {});

 private:
  struct Mesh {
    std::vector<MeshVertex> vertices;
    std::vector<std::uint32_t> indices;
  };
  std::deque<Mesh> meshes_;
};

}  // namespace st
