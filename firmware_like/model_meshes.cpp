#include "firmware_like/model_meshes.hpp"

namespace st {

MeshView ModelMeshes::extract(const Volume& volume, const Pose& T_mesh_volume) {
  constexpr std::size_t kLeastTriangles = 50;
  MeshScratch scratch;
  Bump measure;
  scratch.bind(measure, volume.side);
  std::vector<std::uint8_t> memory(measure.used() + Bump::kAlign);
  Bump bump(memory.data(), memory.size());
  scratch.bind(bump, volume.side);
  const MeshCounts counts = count_mesh(volume, {}, scratch);
  Mesh& mesh = meshes_.emplace_back();
  mesh.vertices.resize(counts.vertices);
  mesh.indices.resize(3 * counts.triangles);
  extract_mesh(volume, {}, scratch, mesh.vertices, mesh.indices);
  std::vector<std::uint32_t> fragments(2 * counts.vertices);
  const MeshCounts kept = remove_fragments(mesh.vertices, mesh.indices, kLeastTriangles, fragments);
  mesh.vertices.resize(kept.vertices);
  mesh.indices.resize(3 * kept.triangles);
  const PoseF T = to_float(T_mesh_volume);
  for (MeshVertex& vertex : mesh.vertices) {
    vertex.position = T * vertex.position;
    vertex.normal = T.R * vertex.normal;
  }
  return {mesh.vertices, mesh.indices};
}

}  // namespace st
