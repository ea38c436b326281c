#include <algorithm>
#include <array>
#include <vector>

#include "firmware_like/scene_cut.hpp"

namespace st {
namespace {

// An edge with a triangle on one side only, in that triangle's direction.
struct Border {
  std::uint32_t from, to;
};

std::vector<Border> borders_of(const Mesh& mesh) {
  struct Edge {
    std::uint32_t low, high, from;
  };
  std::vector<Edge> edges;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = mesh.indices[t + c], b = mesh.indices[t + (c + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a});
    }
  std::ranges::stable_sort(edges, {}, [](const Edge& e) { return std::array{e.low, e.high}; });
  std::vector<Border> borders;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 1)
      borders.push_back({edges[i].from, edges[i].from == edges[i].low ? edges[i].high : edges[i].low});
    i = end;
  }
  return borders;
}

}  // namespace

// Every border edge near the plane gets a wall down to it; the bottom is a fan about the middle of the
// footprint, which closes any outline, and folds onto itself only where the outline is not star-shaped.
void close_bottom(Mesh& mesh, float highest_m) {
  const std::vector<Border> borders = borders_of(mesh);
  std::vector<std::uint32_t> below(mesh.vertices.size());  // the vertex under this one, plus one
  const auto foot_of = [&](std::uint32_t vertex) {
    if (below[vertex] == 0) {
      MeshVertex foot = mesh.vertices[vertex];
      foot.position.z = 0;
      foot.normal = {0, 0, -1};
      foot.observations = 0;  // nobody saw it
      mesh.vertices.push_back(foot);
      below[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
    }
    return below[vertex] - 1;
  };
  const auto is_low = [&](std::uint32_t vertex) { return mesh.vertices[vertex].position.z < highest_m; };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  MeshVertex middle;
  middle.normal = {0, 0, -1};
  middle.r = middle.g = middle.b = 128;
  std::uint32_t centre = 0;
  bool has_centre = false;
  for (const Border& edge : borders) {
    if (!is_low(edge.from) || !is_low(edge.to)) continue;
    if (!has_centre) {
      mesh.vertices.push_back(middle);
      centre = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
      has_centre = true;
    }
    const std::uint32_t a = foot_of(edge.from), b = foot_of(edge.to);
    add(edge.to, edge.from, a);
    add(edge.to, a, b);
    add(b, a, centre);
  }
}

}  // namespace st
