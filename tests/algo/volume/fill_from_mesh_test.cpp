#include "algo/volume/fill_from_mesh.hpp"

#include "tests/algo/volume/analytic_view.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

// A box of twelve triangles, red on the +x half.
struct BoxMesh {
  explicit BoxMesh(const Vec3& h) {
    const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const Vec3f normals[6] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
    for (int f = 0; f < 6; ++f) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (const int c : faces[f]) {
        MeshVertex v;
        v.position =
            to_float(Vec3{(c & 1) != 0 ? h.x : -h.x, (c & 2) != 0 ? h.y : -h.y, (c & 4) != 0 ? h.z : -h.z});
        v.normal = normals[f];
        v.r = (c & 1) != 0 ? 250 : 10;
        vertices.push_back(v);
      }
      for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + k);
    }
  }
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;
};

}  // namespace

TEST_GROUP(FillFromMesh){};

TEST(FillFromMesh, DistancesAreExactAndSigned) {
  const Vec3 h{0.11, 0.07, 0.04};
  const BoxMesh mesh(h);
  const Box box(h);
  Bench bench(128);
  bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
  fill_from_mesh({mesh.vertices, mesh.indices}, bench.volume);
  int seen = 0;
  for (int z = 0; z < 128; z += 3)
    for (int y = 0; y < 128; y += 3)
      for (int x = 0; x < 128; x += 3) {
        const double d = box.distance(to_double(bench.volume.position(x, y, z)));
        const std::size_t i = bench.volume.index(x, y, z);
        if (std::fabs(d) > 0.0155) continue;
        ++seen;
        DOUBLES_EQUAL(std::fabs(d), std::fabs(bench.volume.tsdf[i] * 0.016 / 32767), 2e-5);
        if (std::fabs(d) > 1e-4) CHECK_EQUAL(d < 0, bench.volume.tsdf[i] < 0);
      }
  CHECK_TRUE(seen > 500);
  const ColorSample red = sample_color(bench.volume, {0.109f, 0, 0}),
                    dark = sample_color(bench.volume, {-0.109f, 0, 0});
  CHECK_TRUE(red.valid && red.r > 200 && dark.valid && dark.r < 60);
}

TEST(FillFromMesh, RaysAndMeshesSeeIt) {
  const BoxMesh mesh({0.11, 0.07, 0.04});
  Bench bench(128);
  bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
  fill_from_mesh({mesh.vertices, mesh.indices}, bench.volume);
  const Pose T = looking_at(1.0, 0.4, 0.6);
  std::mt19937 random(1);
  const View view = render(Box({0.11, 0.07, 0.04}), T, {}, random);
  const RaycastStats stats = raycast(bench.volume, view.camera, view.roi, T, bench.raycasting, bench.maps);
  int expected = 0;
  for (const std::uint8_t owner : view.owners) expected += owner;
  CHECK_TRUE(stats.hits > 0.95 * expected && stats.hits < 1.05 * expected);
}
