// A round thing that turns on the spot uncovers nothing, but its markings move. This watches the brightness
// edges of the things in the background through the colour camera. Edges, as relative differences of
// neighbouring brightness, outlast exposure changes and smooth shadows; a shadow's own edge adds some and
// takes hardly any away.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/records.hpp"
#include "algo/depth/depth_tables.hpp"
#include "algo/segmentation/background.hpp"
#include "algo/segmentation/protos.hpp"

namespace st {

class ProtoTexture {
 public:
  void bind(Bump& memory, int width, int height);
  void clear();

  // Finds where the colour camera sees each cell of each thing, at its background's depth. Forgets the
  // reference.
  void map(const DepthTables& tables, const Background& background, const Protos& protos);

  // Compares a new colour frame with the mean of the first four since map(). Returns the label of a thing
  // whose edges have moved in three frames running, 0 for none. Cells that something hides take no part.
  int observe(const FrameInput& frame, const DepthTables& tables, const Background& background,
              const Protos& protos);

 private:
  static constexpr int kMaxEdges = 8192, kMaxEdgesOfOne = 1024;
  struct Edge {
    std::uint32_t cell[2];
    float before;  // relative difference in the reference
    std::uint8_t label;
  };
  std::uint8_t brightness(const FrameInput& frame, const Background& background, std::uint32_t cell) const;
  void add_to_reference(const FrameInput& frame, const Background& background);
  void collect_edges(const Protos& protos);
  void collect_edge(std::uint32_t cell, std::uint32_t beside, const Protos& protos);

  int width_ = 0, height_ = 0, step_ = 1;  // cells
  std::span<std::uint32_t> byte_;       // of a cell: offset of its red value in the colour image, or kNowhere
  std::span<std::uint16_t> reference_;  // sum of the first frames' brightness, or kUnknown
  std::span<Edge> edges_;
  std::size_t edge_count_ = 0;
  bool mapped_ = false;
  int reference_frames_ = 0;
  int edges_of_[Protos::kMax + 1]{};
  std::uint8_t streak_[Protos::kMax + 1]{};
};

}  // namespace st
