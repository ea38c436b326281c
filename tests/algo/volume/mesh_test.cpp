#include "algo/volume/mesh.hpp"

#include <map>

#include "algo/volume/cube_cases.hpp"
#include "tests/algo/volume/analytic_view.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;
  MeshCounts counts;
};

// How often each directed edge occurs.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed_edges(const Mesh& m) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t < m.indices.size(); t += 3)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{m.indices[t + i], m.indices[t + (i + 1) % 3]}];
  return edges;
}

// Closed and manifold: each edge is walked once in each direction.
bool is_closed(const Mesh& m) {
  const auto edges = directed_edges(m);
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) return false;
  }
  return !edges.empty();
}

double signed_volume(const Mesh& m) {
  double sum = 0;
  for (std::size_t t = 0; t < m.indices.size(); t += 3)
    sum += dot(to_double(m.vertices[m.indices[t]].position),
               cross(to_double(m.vertices[m.indices[t + 1]].position),
                     to_double(m.vertices[m.indices[t + 2]].position))) /
           6;
  return sum;
}

}  // namespace

TEST_GROUP(Mesh) {
  Bench bench{64, 64, 64};
  Volume& v = bench.volume;
  std::vector<std::uint8_t> memory;
  MeshScratch scratch;

  void setup() override {
    Bump measure;
    scratch.bind(measure, 64);
    memory.resize(measure.used() + Bump::kAlign);
    Bump real(memory.data(), memory.size());
    scratch.bind(real, 64);
    v.reset(0.004f, 0.016f, {0, 0, 0});
  }

  // Exact distances everywhere, so that the surface is closed.
  template <typename F>
  void fill(F && distance_m) {
    for (int z = 0; z < v.side; ++z)
      for (int y = 0; y < v.side; ++y)
        for (int x = 0; x < v.side; ++x) {
          const double t = distance_m(to_double(v.position(x, y, z))) / static_cast<double>(v.truncation_m);
          const std::size_t i = v.index(x, y, z);
          v.tsdf[i] = static_cast<std::int16_t>(std::lround(std::fmin(std::fmax(t, -1.0), 1.0) * 32767));
          v.weight[i] = 20;
          v.observations[i] = 9;
          v.color[i] = pack_rgb(200, 100, 50, 0xF2);
          std::uint8_t& flags = v.bricks[v.brick_index(x / 8, y / 8, z / 8)];
          flags = static_cast<std::uint8_t>(flags | kBrickTouched | (t < 0 ? kBrickSolid : 0));
        }
  }
  Mesh extract() {
    Mesh m;
    const MeshCounts wanted = count_mesh(v, {}, scratch);
    m.vertices.resize(wanted.vertices);
    m.indices.resize(3 * wanted.triangles);
    m.counts = extract_mesh(v, {}, scratch, m.vertices, m.indices);
    UNSIGNED_LONGS_EQUAL(wanted.vertices, m.counts.vertices);
    UNSIGNED_LONGS_EQUAL(wanted.triangles, m.counts.triangles);
    UNSIGNED_LONGS_EQUAL(0, m.counts.refused_triangles);
    return m;
  }
};

TEST(Mesh, ABallIsClosedOutwardAndOnTheZeroLevel) {
  const Sphere ball(0.08);
  fill([&](const Vec3& p) { return ball.distance(p); });
  const Mesh m = extract();
  CHECK(is_closed(m));
  DOUBLES_EQUAL(4.0 / 3 * 3.14159265 * 0.08 * 0.08 * 0.08, signed_volume(m), 2e-5);
  // Euler's formula for a sphere: V - E + F = 2, E = 3F / 2.
  LONGS_EQUAL(2, static_cast<long>(m.counts.vertices) - static_cast<long>(m.counts.triangles) / 2);
  for (const MeshVertex& q : m.vertices) {
    DOUBLES_EQUAL(0, ball.distance(to_double(q.position)), 0.00006);
    CHECK(norm(to_double(q.normal) - ball.normal(to_double(q.position))) < 0.02);
    LONGS_EQUAL(200, q.r);
    LONGS_EQUAL(50, q.b);
    LONGS_EQUAL(9, q.observations);
  }
}

TEST(Mesh, RandomFieldsStayClosedAndManifold) {
  // White noise meets every one of the 256 cases, the ambiguous ones among them; a solid-free rim closes it.
  std::mt19937 random(4);
  fill([&](const Vec3& p) {
    const bool rim = std::fabs(p.x) > 0.11 || std::fabs(p.y) > 0.11 || std::fabs(p.z) > 0.11;
    return rim ? 0.01 : static_cast<double>(random() % 2001) * 1e-5 - 0.01;
  });
  const Mesh m = extract();
  CHECK(m.counts.triangles > 100000);
  CHECK(is_closed(m));
  CHECK(signed_volume(m) > 0);
}

TEST(Mesh, CasesCutEveryEdgeWithUnequalEndsAndNoOther) {
  for (int c = 0; c < 256; ++c) {
    int used = 0;
    for (int i = 0; i < 3 * kCubeCases.of[c].triangles; ++i) used |= 1 << kCubeCases.of[c].edges[i];
    for (int e = 0; e < 12; ++e) {
      const CubeEdge edge = cube_edge(e);
      const bool cut = ((c >> edge.from) & 1) != ((c >> (edge.from | (1 << edge.axis))) & 1);
      CHECK_EQUAL(cut, ((used >> e) & 1) != 0);
    }
  }
}

TEST(Mesh, CellsWithUnseenOrBarelySeenVoxelsAreLeftOpen) {
  const Sphere ball(0.08);
  fill([&](const Vec3& p) { return ball.distance(p); });
  const std::size_t all = count_mesh(v, {}, scratch).triangles;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      v.tsdf[v.index(x, y, 32)] = kUnseen;
      v.observations[v.index(x, y, 20)] = 1;
    }
  const Mesh m = extract();
  CHECK(m.counts.triangles < all);
  for (const MeshVertex& q : m.vertices) CHECK(std::fabs(q.position.z - v.position(0, 0, 32).z) > 0.0039f);
}

TEST(Mesh, WhatDoesNotFitIsCountedAndNothingIsOverrun) {
  const Sphere ball(0.08);
  fill([&](const Vec3& p) { return ball.distance(p); });
  const MeshCounts all = count_mesh(v, {}, scratch);
  std::vector<MeshVertex> vertices(all.vertices / 2);
  std::vector<std::uint32_t> indices(3 * all.triangles + 3, 0xABCDu);
  MeshCounts some = extract_mesh(v, {}, scratch, vertices, indices);
  CHECK(some.refused_triangles > 0);
  UNSIGNED_LONGS_EQUAL(all.triangles, some.triangles + some.refused_triangles);
  for (std::size_t i = 0; i < 3 * some.triangles; ++i) CHECK(indices[i] < some.vertices);
  vertices.resize(all.vertices);
  some = extract_mesh(v, {}, scratch, vertices, std::span(indices).subspan(0, 300));
  UNSIGNED_LONGS_EQUAL(100, some.triangles);
}

TEST(Mesh, SameVolumeSameMesh) {
  const Sphere ball(0.08);
  fill([&](const Vec3& p) { return ball.distance(p); });
  const Mesh a = extract(), b = extract();
  CHECK(a.indices == b.indices);
  MEMCMP_EQUAL(&a.vertices[0].position, &b.vertices[0].position, 12);
}

TEST(Mesh, FloatersGoAndTheObjectStaysClosed) {
  const Sphere ball(0.07), crumb(0.008);
  fill([&](const Vec3& p) { return std::fmin(ball.distance(p), crumb.distance(p - Vec3{0.1, 0.1, 0.1})); });
  Mesh m = extract();
  const std::size_t with_crumb = m.counts.triangles;
  std::vector<std::uint32_t> numbers(2 * m.vertices.size());
  const MeshCounts left = remove_fragments(m.vertices, m.indices, 200, numbers);
  CHECK(left.triangles < with_crumb);
  m.vertices.resize(left.vertices);
  m.indices.resize(3 * left.triangles);
  CHECK(is_closed(m));
  for (const MeshVertex& q : m.vertices) DOUBLES_EQUAL(0, ball.distance(to_double(q.position)), 0.0001);
  LONGS_EQUAL(2, static_cast<long>(left.vertices) - static_cast<long>(left.triangles) / 2);
}

TEST(Mesh, AModelFusedFromNoisyViewsHasItsVerticesOnTheSolid) {
  Bench fused(96);
  fused.volume.reset(0.004f, 0.016f, {0, 0, 0});
  const Disc disc(0.15, 0.045);
  std::mt19937 random(6);
  Rendering how;
  how.noise = 1;
  for (int i = 0; i < 24; ++i) fused.fuse(render(disc, looking_at(0.9, 0.5 * i, 0.5), how, random));
  std::vector<std::uint8_t> room;
  Bump measure;
  MeshScratch own;
  own.bind(measure, 96);
  room.resize(measure.used() + Bump::kAlign);
  Bump real(room.data(), room.size());
  own.bind(real, 96);
  const MeshCounts wanted = count_mesh(fused.volume, {}, own);
  std::vector<MeshVertex> vertices(wanted.vertices);
  std::vector<std::uint32_t> indices(3 * wanted.triangles);
  extract_mesh(fused.volume, {}, own, vertices, indices);
  double sum = 0;
  for (const MeshVertex& q : vertices) sum += std::fabs(disc.distance(to_double(q.position)));
  CHECK(vertices.size() > 5000);
  CHECK(sum / static_cast<double>(vertices.size()) < 0.0012);
}
