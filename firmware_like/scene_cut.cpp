#include "firmware_like/scene_cut.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/disjoint_sets.hpp"

namespace st {
namespace {

constexpr double kThickness_m = 0.012;  // of the plane: what noise and voxels make of it
constexpr double kClearance_m = 0.015;  // so much above it a thing begins
constexpr double kFlat = 0.94;          // cosine of 20 degrees
constexpr double kUpright = 0.5;        // cosine of 60 degrees

double height_over(const SupportPlane& plane, const Vec3f& p) {
  return dot(plane.normal, to_double(p)) - plane.distance_m;
}

bool lies_in(const SupportPlane& plane, const MeshVertex& v) {
  return std::fabs(height_over(plane, v.position)) < kThickness_m &&
         dot(plane.normal, to_double(v.normal)) > kFlat;
}

// Mean normal and middle of the vertices that lie in the plane.
SupportPlane refined(const MeshView& scene, const SupportPlane& plane) {
  Vec3 normal{}, middle{};
  std::size_t count = 0;
  for (const MeshVertex& v : scene.vertices) {
    if (!lies_in(plane, v)) continue;
    normal += to_double(v.normal);
    middle += to_double(v.position);
    ++count;
  }
  if (count == 0) return plane;
  const Vec3 unit = normalized(normal);
  return {true, unit, dot(unit, middle * (1.0 / static_cast<double>(count)))};
}

double axis_distance(std::span<const Pose> poses, const Vec3& p) {
  double sum = 0;
  for (const Pose& T : poses) sum += norm(cross(p - T.t, T.R.col(2)));
  return poses.empty() ? 0 : sum / static_cast<double>(poses.size());
}

// Two level directions.
struct Level {
  Vec3 x, y;
};
Level level_of(const SupportPlane& plane) {
  const Vec3 ahead{0, 0, 1}, down{0, 1, 0};
  Vec3 x = ahead - plane.normal * dot(ahead, plane.normal);
  if (norm(x) < 0.05) x = down - plane.normal * dot(down, plane.normal);
  x = normalized(x);
  return {x, cross(plane.normal, x)};
}

void measure(Cluster& cluster, const SupportPlane& plane, std::span<const Pose> poses) {
  const Level level = level_of(plane);
  double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
  cluster.low_m = 1e9;
  Vec3 sum{};
  for (const MeshVertex& v : cluster.mesh.vertices) {
    const Vec3 p = to_double(v.position);
    sum += p;
    const double height = height_over(plane, v.position), at[2] = {dot(p, level.x), dot(p, level.y)};
    cluster.low_m = std::min(cluster.low_m, height);
    cluster.height_m = std::max(cluster.height_m, height);
    for (int a = 0; a < 2; ++a) low[a] = std::min(low[a], at[a]), high[a] = std::max(high[a], at[a]);
  }
  cluster.centroid = sum * (1.0 / static_cast<double>(cluster.mesh.vertices.size()));
  cluster.width_m = std::max(high[0] - low[0], high[1] - low[1]);
  cluster.off_centre_m = axis_distance(poses, cluster.centroid);
}

}  // namespace

SupportPlane find_support(const MeshView& scene) {
  constexpr std::size_t kProposals = 300;
  SupportPlane best;
  std::size_t most = scene.vertices.size() / 20;
  const std::size_t step = std::max<std::size_t>(1, scene.vertices.size() / kProposals);
  for (std::size_t i = 0; i < scene.vertices.size(); i += step) {
    const MeshVertex& v = scene.vertices[i];
    if (-v.normal.y < static_cast<float>(kUpright)) continue;
    const Vec3 normal = normalized(to_double(v.normal));
    const SupportPlane plane = refined(scene, {true, normal, dot(normal, to_double(v.position))});
    std::size_t count = 0;
    for (const MeshVertex& other : scene.vertices) count += lies_in(plane, other) ? 1u : 0u;
    if (count > most) most = count, best = plane;
  }
  return best.found ? refined(scene, best) : best;
}

std::vector<Cluster> find_clusters(const MeshView& scene, const SupportPlane& plane,
                                   std::span<const Pose> poses) {
  constexpr std::size_t kLeastTriangles = 100;
  constexpr double kComesDownTo_m = 0.06, kWidest_m = 1.2;
  const std::size_t n = scene.vertices.size();
  std::vector<std::uint8_t> above(n);
  for (std::size_t i = 0; i < n; ++i)
    above[i] = height_over(plane, scene.vertices[i].position) > kClearance_m ? 1 : 0;
  std::vector<std::uint32_t> parents(n);
  DisjointSets sets(parents);
  std::vector<std::uint32_t> triangles;  // those wholly above the plane, by their first index
  for (std::uint32_t t = 0; t + 2 < scene.indices.size(); t += 3) {
    const std::uint32_t* corner = &scene.indices[t];
    if (above[corner[0]] + above[corner[1]] + above[corner[2]] < 3) continue;
    sets.join(corner[0], corner[1]);
    sets.join(corner[0], corner[2]);
    triangles.push_back(t);
  }
  const auto root_of = [&](std::uint32_t t) { return sets.root(scene.indices[t]); };
  std::ranges::stable_sort(triangles, {}, root_of);

  std::vector<Cluster> clusters;
  std::vector<std::uint32_t> number(n);  // of a vertex in its cluster, plus one
  for (std::size_t from = 0, to = 0; from < triangles.size(); from = to) {
    const std::uint32_t root = root_of(triangles[from]);
    while (to < triangles.size() && root_of(triangles[to]) == root) ++to;
    if (to - from < kLeastTriangles) continue;
    Cluster cluster;
    for (std::size_t i = from; i < to; ++i)
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t vertex = scene.indices[triangles[i] + c];
        if (number[vertex] == 0) {
          cluster.mesh.vertices.push_back(scene.vertices[vertex]);
          number[vertex] = static_cast<std::uint32_t>(cluster.mesh.vertices.size());
        }
        cluster.mesh.indices.push_back(number[vertex] - 1);
      }
    measure(cluster, plane, poses);
    if (cluster.low_m < kComesDownTo_m && cluster.width_m < kWidest_m) clusters.push_back(std::move(cluster));
  }
  std::ranges::stable_sort(clusters, {}, &Cluster::off_centre_m);
  return clusters;
}

Mesh in_own_frame(const Cluster& cluster, const SupportPlane& plane) {
  const Level level = level_of(plane);
  const Mat3 R_world_own = Mat3::from_columns(level.x, level.y, plane.normal);
  Vec3 low{1e9, 1e9, 0}, high{-1e9, -1e9, 0};
  for (const MeshVertex& v : cluster.mesh.vertices) {
    const Vec3 p = R_world_own.transposed() * to_double(v.position);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), 0};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
  }
  const Vec3 foot{0.5 * (low.x + high.x), 0.5 * (low.y + high.y), plane.distance_m};
  const PoseF T_own_world = to_float(Pose{R_world_own, R_world_own * foot}.inverse());
  Mesh mesh = cluster.mesh;
  for (MeshVertex& v : mesh.vertices) {
    v.position = T_own_world * v.position;
    v.normal = T_own_world.R * v.normal;
  }
  return mesh;
}

}  // namespace st
