// Cuts things out of a scanned scene: the plane that they stand on goes, and what then hangs together is
// offered as clusters. After the loop; allocates.
#pragma once

#include <span>
#include <vector>

#include "algo/core/pose.hpp"
#include "hal/results/ply_file.hpp"

namespace st {

// What things stand on: normal . p = distance, the normal away from the solid.
struct SupportPlane {
  bool found = false;
  Vec3 normal{};
  double distance_m = 0;
};

// The largest plane of the scene that may carry something: normals within 60 degrees of up in the first
// camera's picture (world frame: -y). The same scene gives the same plane. Not found when no plane holds a
// twentieth of the vertices.
SupportPlane find_support(const MeshView& scene);

struct Cluster {
  Mesh mesh;                                    // world frame
  Vec3 centroid{};                              // of its vertices
  double low_m = 0, height_m = 0, width_m = 0;  // lowest and highest above the plane; widest across it
  double off_centre_m = 0;                      // mean distance of the centroid from the camera's axis
};

// What stands on the plane: connected pieces of the surface above it that come down to it and are no wall,
// the most central first. `poses`: T_world_camera over the scan.
std::vector<Cluster> find_clusters(const MeshView& scene, const SupportPlane& plane,
                                   std::span<const Pose> poses);

// The cluster in its own frame: origin on the plane below the middle of its footprint, z up, x along the
// first camera's axis laid on the plane.
Mesh in_own_frame(const Cluster& cluster, const SupportPlane& plane);

// Goes on with the walls of a mesh in its own frame, from where the cut left them down to z = 0, and closes
// it there. Holes higher than `highest_m` stay.
void close_bottom(Mesh& mesh, float highest_m);

}  // namespace st
