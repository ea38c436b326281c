#include "algo/core/disjoint_sets.hpp"
#include "algo/volume/mesh.hpp"

namespace st {

MeshCounts remove_fragments(std::span<MeshVertex> vertices, std::span<std::uint32_t> indices,
                            std::size_t least_triangles, std::span<std::uint32_t> scratch) {
  const std::size_t n = vertices.size();
  DisjointSets sets(scratch.subspan(0, n));
  const std::span<std::uint32_t> count = scratch.subspan(n, n);
  for (std::uint32_t& c : count) c = 0;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    sets.join(indices[t], indices[t + 1]);
    sets.join(indices[t], indices[t + 2]);
  }
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) ++count[sets.root(indices[t])];
  const auto kept = [&](std::uint32_t vertex) { return count[sets.root(vertex)] >= least_triangles; };

  MeshCounts left;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    if (!kept(indices[t])) continue;
    for (std::size_t i = 0; i < 3; ++i) indices[3 * left.triangles + i] = indices[t + i];
    ++left.triangles;
  }
  // New numbers go where the counts were; a count is read for the last time through its root, which is never
  // larger than the vertex, so the marks are taken first.
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t v = static_cast<std::uint32_t>(i), r = sets.root(v);
    const bool keep = r == v ? count[v] >= least_triangles : count[r] != 0xFFFFFFFFu;
    if (!keep) {
      count[i] = 0xFFFFFFFFu;
      continue;
    }
    vertices[left.vertices] = vertices[i];
    count[i] = static_cast<std::uint32_t>(left.vertices++);
  }
  for (std::size_t i = 0; i < 3 * left.triangles; ++i) indices[i] = count[indices[i]];
  return left;
}

}  // namespace st
