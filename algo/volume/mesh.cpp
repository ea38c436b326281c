#include "algo/volume/mesh.hpp"

#include <cmath>
#include <cstring>

#include "algo/volume/cube_cases.hpp"

namespace st {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

struct Cell {
  int x, y, z;
};

// Walks the cells in memory order and writes vertices and triangles, or only counts them when there is no
// memory for them.
class Extractor {
 public:
  Extractor(const Volume& volume, const MeshOptions& options, MeshScratch& scratch,
            std::span<MeshVertex> vertices, std::span<std::uint32_t> indices, bool counting)
      : v_(volume),
        options_(options),
        s_(scratch),
        vertices_(vertices),
        indices_(indices),
        counting_(counting),
        n_(static_cast<std::size_t>(volume.side)) {}

  MeshCounts run() {
    mark_bricks();
    std::memset(s_.edges.data(), 0xFF, 6 * n_ * n_ * sizeof(std::uint32_t));
    for (int z = 0; z + 1 < v_.side; ++z) {
      // Edges of the slice above become those below; what is above is not known yet.
      if (z > 0) std::memset(slice(z + 1), 0xFF, 3 * n_ * n_ * sizeof(std::uint32_t));
      for (int y = 0; y + 1 < v_.side; ++y)
        for (int x = 0; x + 1 < v_.side; ++x) {
          if (s_.wanted[v_.brick_index(x / kBrickSide, y / kBrickSide, z / kBrickSide)] == 0) {
            x |= kBrickSide - 1;  // to the brick's last cell
            continue;
          }
          cell({x, y, z});
        }
    }
    return counts_;
  }

 private:
  // A cell belongs to the brick of its lowest corner and reaches one voxel into the next ones.
  void mark_bricks() {
    const int b = v_.bricks_a_side();
    std::memset(s_.wanted.data(), 0,
                static_cast<std::size_t>(b) * static_cast<std::size_t>(b) * static_cast<std::size_t>(b));
    for (int z = 0; z < b; ++z)
      for (int y = 0; y < b; ++y)
        for (int x = 0; x < b; ++x) {
          if ((v_.bricks[v_.brick_index(x, y, z)] & kBrickSolid) == 0) continue;
          for (int i = 0; i < 8; ++i) {
            const int px = x - (i & 1), py = y - ((i >> 1) & 1), pz = z - (i >> 2);
            if (px >= 0 && py >= 0 && pz >= 0) s_.wanted[v_.brick_index(px, py, pz)] = 1;
          }
        }
  }

  std::uint32_t* slice(int z) { return &s_.edges[static_cast<std::size_t>(z & 1) * 3 * n_ * n_]; }

  void cell(const Cell& c) {
    std::size_t at[8];
    int inside = 0;
    for (int i = 0; i < 8; ++i) {
      at[i] = v_.index(c.x + (i & 1), c.y + ((i >> 1) & 1), c.z + (i >> 2));
      if (v_.tsdf[at[i]] == kUnseen || v_.observations[at[i]] < options_.least_observations) return;
      if (v_.tsdf[at[i]] < 0) inside |= 1 << i;
    }
    const CubeCase& cube = kCubeCases.of[inside];
    for (int t = 0; t < cube.triangles; ++t) triangle(c, &cube.edges[3 * t]);
  }

  void triangle(const Cell& c, const std::uint8_t* edges) {
    std::uint32_t corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = vertex(c, edges[i]);
    const bool fits = corner[0] != kNone && corner[1] != kNone && corner[2] != kNone &&
                      (counting_ || 3 * counts_.triangles + 3 <= indices_.size());
    if (!fits) {
      ++counts_.refused_triangles;
      return;
    }
    if (!counting_)
      for (std::size_t i = 0; i < 3; ++i) indices_[3 * counts_.triangles + i] = corner[i];
    ++counts_.triangles;
  }

  // Number of the vertex on an edge of the cell, made when it is met first; kNone when there is no room.
  std::uint32_t vertex(const Cell& c, int edge) {
    const CubeEdge e = cube_edge(edge);
    const Cell from{c.x + (e.from & 1), c.y + ((e.from >> 1) & 1), c.z + (e.from >> 2)};
    std::uint32_t& kept =
        slice(from.z)[3 * (static_cast<std::size_t>(from.y) * n_ + static_cast<std::size_t>(from.x)) +
                      static_cast<std::size_t>(e.axis)];
    if (kept != kNone) return kept;
    if (!counting_ && counts_.vertices >= vertices_.size()) return kNone;
    if (!counting_) vertices_[counts_.vertices] = vertex_between(from, e.axis);
    return kept = static_cast<std::uint32_t>(counts_.vertices++);
  }

  MeshVertex vertex_between(const Cell& a, int axis) const {
    const Cell b{a.x + (axis == 0 ? 1 : 0), a.y + (axis == 1 ? 1 : 0), a.z + (axis == 2 ? 1 : 0)};
    const std::size_t ia = v_.index(a.x, a.y, a.z), ib = v_.index(b.x, b.y, b.z);
    const float va = v_.tsdf[ia], vb = v_.tsdf[ib];
    // Off the corners by a hair, so that no triangle shrinks to a point.
    constexpr float kHair = 1.0f / 256.0f;
    float t = va / (va - vb);
    t = t < kHair ? kHair : t > 1 - kHair ? 1 - kHair : t;
    MeshVertex o;
    o.position = v_.position(a.x, a.y, a.z) + (v_.position(b.x, b.y, b.z) - v_.position(a.x, a.y, a.z)) * t;
    o.normal = normalized(gradient(a) * (1 - t) + gradient(b) * t);
    o.observations = v_.observations[t < 0.5f ? ia : ib];
    paint(o, v_.color[ia], v_.color[ib], t);
    return o;
  }

  // Central difference where both neighbours are seen, else from the one that is.
  Vec3f gradient(const Cell& c) const {
    Vec3f g{};
    const std::size_t at = v_.index(c.x, c.y, c.z);
    const std::size_t step[3] = {1, n_, n_ * n_};
    const int place[3] = {c.x, c.y, c.z};
    for (int a = 0; a < 3; ++a) {
      const bool below = place[a] > 0 && v_.tsdf[at - step[a]] != kUnseen;
      const bool above = place[a] + 1 < v_.side && v_.tsdf[at + step[a]] != kUnseen;
      const float low = below ? v_.tsdf[at - step[a]] : v_.tsdf[at],
                  high = above ? v_.tsdf[at + step[a]] : v_.tsdf[at];
      g[a] = below && above ? 0.5f * (high - low) : high - low;
    }
    return g;
  }

  static void paint(MeshVertex& o, std::uint32_t a, std::uint32_t b, float t) {
    constexpr std::uint8_t kGrey = 128;  // no colour was ever seen here
    const bool has_a = color_trust_of(a) > 0, has_b = color_trust_of(b) > 0;
    o.r = o.g = o.b = kGrey;
    if (!has_a && !has_b) return;
    const float share = has_a && has_b ? t : has_b ? 1.0f : 0.0f;
    const auto mix = [share](std::uint8_t p, std::uint8_t q) {
      return static_cast<std::uint8_t>(static_cast<float>(p) +
                                       share * (static_cast<float>(q) - static_cast<float>(p)) + 0.5f);
    };
    o.r = mix(red_of(a), red_of(b));
    o.g = mix(green_of(a), green_of(b));
    o.b = mix(blue_of(a), blue_of(b));
  }

  const Volume& v_;
  MeshOptions options_;
  MeshScratch& s_;
  std::span<MeshVertex> vertices_;
  std::span<std::uint32_t> indices_;
  bool counting_;
  std::size_t n_;
  MeshCounts counts_;
};

}  // namespace

void MeshScratch::bind(Bump& memory, int max_side) {
  const std::size_t n = static_cast<std::size_t>(max_side), b = n / kBrickSide;
  edges = memory.take<std::uint32_t>(6 * n * n);
  wanted = memory.take<std::uint8_t>(b * b * b);
}

MeshCounts count_mesh(const Volume& volume, const MeshOptions& options, MeshScratch& scratch) {
  return Extractor(volume, options, scratch, {}, {}, true).run();
}

MeshCounts extract_mesh(const Volume& volume, const MeshOptions& options, MeshScratch& scratch,
                        std::span<MeshVertex> vertices, std::span<std::uint32_t> indices) {
  return Extractor(volume, options, scratch, vertices, indices, false).run();
}

}  // namespace st
