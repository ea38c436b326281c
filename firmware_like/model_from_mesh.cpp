#include "firmware_like/model_from_mesh.hpp"

#include <algorithm>

#include "algo/tracking/birth.hpp"
#include "algo/volume/fill_from_mesh.hpp"
#include "firmware_like/heap_memory.hpp"
#include "firmware_like/model_meshes.hpp"
#include "hal/error.hpp"

namespace st {
namespace {

constexpr int kSide = 128;
constexpr double kSmallest_m = 0.01, kLargest_m = 3.0, kMargin = 1.3;
constexpr double kAboveFloor_m = 0.03;  // what a scan leaves open

}  // namespace

OwnedModel model_from_mesh(const MeshView& mesh, const std::string& name) {
  ModelTraits traits;
  for (const MeshVertex& vertex : mesh.vertices) traits.bounds.include(to_double(vertex.position));
  const Vec3 size = traits.bounds.size();
  const double extent = std::max({size.x, size.y, size.z});
  if (!(extent > kSmallest_m && extent < kLargest_m))
    throw Failure(ExitCode::kBadInput,
                  name + ": is " + std::to_string(extent) +
                      " m long; an object is 0.01 to 3 m (use --scale 0.001 for millimetres)");
  if (const double low = traits.bounds.low.z; !(low > -kAboveFloor_m && low < kAboveFloor_m))
    throw Failure(ExitCode::kBadInput, name + ": its lowest point is at z = " + std::to_string(low) +
                                           " m; an object stands on z = 0 with z up: shift or turn the mesh");
  const auto voxel_m = static_cast<float>(std::max(kLeastBox_m, kMargin * extent) / kSide);
  Volume volume;
  const HeapMemory memory([&](Bump& bump) { volume.bind(bump, kSide); });
  volume.reset(voxel_m, choose_truncation_m(voxel_m, depth_sigma_m(1.5f)), to_float(traits.bounds.centre()));
  fill_from_mesh(mesh, volume);
  return describe_volume(volume, traits);
}

MeshView mesh_of(const KnownModel& model, ModelMeshes& meshes) {
  Volume volume;
  const HeapMemory memory([&](Bump& bump) { volume.bind(bump, model.volume.side); });
  if (!unpack(model.volume, volume)) return {};
  return meshes.extract(volume);
}

}  // namespace st
