#include "firmware_like/scene_cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;

namespace {

// A grid of quads from `origin` along u and v, facing v x u, in cells of about a centimetre; world frame.
void add_patch(Mesh& mesh, const Vec3f& origin, const Vec3f& u, const Vec3f& v) {
  const int nu = std::max(1, static_cast<int>(norm(u) * 100)),
            nv = std::max(1, static_cast<int>(norm(v) * 100));
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      MeshVertex x;
      x.position = origin + u * (static_cast<float>(i) / static_cast<float>(nu)) +
                   v * (static_cast<float>(j) / static_cast<float>(nv));
      x.normal = normalized(cross(v, u));
      mesh.vertices.push_back(x);
    }
  const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (nu + 1) + i); };
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i)
      for (const std::uint32_t k :
           {at(i, j), at(i + 1, j + 1), at(i + 1, j), at(i, j), at(i, j + 1), at(i + 1, j + 1)})
        mesh.indices.push_back(k);
}

// World: y down, the floor at y = 1. An upright box without a bottom, whose faces share their corners only
// once vertices at one place are made one.
void add_box(Mesh& mesh, float x, float z, float side, float tall) {
  const float low = 1.0f, high = 1.0f - tall;
  Mesh box;
  add_patch(box, {x, high, z}, {0, 0, side}, {side, 0, 0});                 // the top
  add_patch(box, {x, low, z}, {0, -tall, 0}, {side, 0, 0});                 // towards the camera
  add_patch(box, {x + side, low, z + side}, {0, -tall, 0}, {-side, 0, 0});  // away from it
  add_patch(box, {x, low, z + side}, {0, -tall, 0}, {0, 0, -side});
  add_patch(box, {x + side, low, z}, {0, -tall, 0}, {0, 0, side});
  std::map<std::array<int, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> number;
  for (const MeshVertex& v : box.vertices) {
    const std::array<int, 3> key{static_cast<int>(std::lround(v.position.x * 1e4f)),
                                 static_cast<int>(std::lround(v.position.y * 1e4f)),
                                 static_cast<int>(std::lround(v.position.z * 1e4f))};
    const auto [place, fresh] = known.try_emplace(key, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.push_back(v);
    number.push_back(place->second);
  }
  for (const std::uint32_t i : box.indices) mesh.indices.push_back(number[i]);
}

Mesh scene_of_two() {
  Mesh scene;
  add_patch(scene, {-1, 1, 0.5f}, {0, 0, 2}, {2, 0, 0});
  add_patch(scene, {-1, 1, 2.5f}, {0, -1.5f, 0}, {2, 0, 0});  // a wall
  add_box(scene, 0.6f, 1.8f, 0.3f, 0.25f);
  add_box(scene, -0.1f, 1.4f, 0.2f, 0.1f);
  return scene;
}

// Looks at the smaller box.
std::vector<Pose> looks() {
  const double tilt = std::atan2(0.95, 1.5);
  return {Pose{rotation_from_vector({-tilt, 0, 0}), {0, 0, 0}}};
}

std::size_t open_edges(const Mesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, int> sides;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = mesh.indices[t + c], b = mesh.indices[t + (c + 1) % 3];
      sides[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  return static_cast<std::size_t>(std::ranges::count_if(sides, [](const auto& s) { return s.second != 0; }));
}

}  // namespace

TEST_GROUP(SceneCut) { Mesh scene = scene_of_two(); };

TEST(SceneCut, TheFloorIsFoundAndNotTheWall) {
  const SupportPlane plane = find_support(scene.view());
  CHECK(plane.found);
  DOUBLES_EQUAL(-1, plane.normal.y, 1e-4);
  DOUBLES_EQUAL(-1, plane.distance_m, 1e-3);
}

TEST(SceneCut, ASceneWithoutAFloorHasNone) {
  Mesh wall;
  add_patch(wall, {-1, 1, 2.5f}, {0, -1.5f, 0}, {2, 0, 0});
  CHECK(!find_support(wall.view()).found);
  CHECK(!find_support({}).found);
}

TEST(SceneCut, WhatStandsOnTheFloorComesTheMostCentralFirst) {
  const std::vector<Pose> poses = looks();
  const std::vector<Cluster> clusters = find_clusters(scene.view(), find_support(scene.view()), poses);
  UNSIGNED_LONGS_EQUAL(2, clusters.size());  // the wall is too wide for a thing
  DOUBLES_EQUAL(0.2, clusters[0].width_m, 0.02);
  DOUBLES_EQUAL(0.1, clusters[0].height_m, 0.01);
  DOUBLES_EQUAL(0.3, clusters[1].width_m, 0.02);
  CHECK(clusters[0].off_centre_m < clusters[1].off_centre_m);
}

TEST(SceneCut, InItsOwnFrameAThingStandsOnZeroAboutTheOrigin) {
  const std::vector<Pose> poses = looks();
  const SupportPlane plane = find_support(scene.view());
  const Mesh own = in_own_frame(find_clusters(scene.view(), plane, poses)[0], plane);
  float low = 1, high = -1, left = 1, right = -1;
  for (const MeshVertex& v : own.vertices) {
    low = std::min(low, v.position.z), high = std::max(high, v.position.z);
    left = std::min(left, v.position.x), right = std::max(right, v.position.x);
  }
  DOUBLES_EQUAL(0.1, high, 0.002);
  CHECK(low > 0 && low < 0.03);
  DOUBLES_EQUAL(0, left + right, 1e-4);
}

TEST(SceneCut, AClosedBottomLeavesNoOpenEdge) {
  const std::vector<Pose> poses = looks();
  const SupportPlane plane = find_support(scene.view());
  Mesh own = in_own_frame(find_clusters(scene.view(), plane, poses)[0], plane);
  CHECK(open_edges(own) > 0);
  close_bottom(own, 0.06f);
  UNSIGNED_LONGS_EQUAL(0, open_edges(own));
  double volume = 0;  // of the closed solid, by the divergence theorem: positive where faces look outwards
  for (std::size_t t = 0; t < own.indices.size(); t += 3) {
    const Vec3f &a = own.vertices[own.indices[t]].position, &b = own.vertices[own.indices[t + 1]].position,
                &c = own.vertices[own.indices[t + 2]].position;
    volume += static_cast<double>(dot(a, cross(b, c))) / 6;
  }
  DOUBLES_EQUAL(0.2 * 0.2 * 0.1, volume, 0.0004);
}
