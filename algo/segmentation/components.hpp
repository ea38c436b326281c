// Connected components of a sparse code image, split at depth gaps: union-find over horizontal runs, so that
// the work follows the foreground and not the frame. 8-connected. Bounded: runs beyond the capacity are
// refused and counted.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/fixed_vector.hpp"
#include "algo/core/image.hpp"
#include "algo/depth/depth_tables.hpp"

namespace st {

// The working grid: the image itself up to 320 columns, every second pixel both ways above.
constexpr int grid_step(int width) { return width > 320 ? 2 : 1; }
constexpr int grid_size(int pixels, int step) { return (pixels + step - 1) / step; }

class Components {
 public:
  static constexpr int kMaxRuns = 16384;

  struct Run {
    std::int16_t v, u0, u1;  // cells [u0, u1) of row v
    std::uint16_t root;      // after label(): index of the component's first run
  };
  struct Stats {  // of a component, valid at its root
    std::uint32_t cells;
    std::uint64_t weighted;  // sum of 2^32 / q^2: proportional to the metric area seen head-on
  };

  // Whether neighbouring cells of these codes belong to one surface; see label().
  static bool together(int a, int b, int gap_steepness) {
    const int far = a < b ? a : b, near = a < b ? b : a;
    return near - far <=
           20 + static_cast<int>((static_cast<std::int64_t>(near) * near * gap_steepness) >> 16);
  }

  void bind(Bump& memory, int grid_width, int grid_height);

  // The image to fill before label(): codes, 0 where there is nothing. begin() clears it.
  ImageView<std::uint16_t> begin();
  ImageView<const std::uint16_t> cells() const { return {cells_.data(), width_, height_}; }

  // `gap_steepness`: cells of codes q and q + dq belong together when dq <= 20 + q^2 * gap_steepness / 2^16;
  // 1 is a step of about 4 cm, plus noise.
  void label(int gap_steepness);

  std::span<const Run> runs() const { return {runs_.data(), run_count_}; }

  // Numbers the components of at least these sizes 1, 2, ... by area, the largest `most` (up to kMaxSelected)
  // of them. Returns how many.
  static constexpr int kMaxSelected = 64;
  int select(std::uint32_t least_cells, std::uint64_t least_weighted, int most);
  int number_of(const Run& run) const { return number_[run.root]; }  // 0: not selected
  const Stats& selected(int number) const { return stats_[selected_[static_cast<std::size_t>(number - 1)]]; }
  // Seen head-on: every cell as a piece of a surface that faces the camera.
  float area_cm2(int number, const DepthTables& tables, int step) const;
  std::uint64_t weighted_of_area(float area_cm2, const DepthTables& tables, int step) const;
  std::uint32_t refused_runs() const { return refused_; }

 private:
  void extract_runs(int gap_steepness);
  void push_run(int v, int u0, int u1);
  void link_rows(int gap_steepness);
  bool touch(const Run& above, const Run& below, int gap_steepness) const;
  std::uint16_t find(std::uint16_t run);
  void unite(std::uint16_t a, std::uint16_t b);

  int width_ = 0, height_ = 0;
  std::span<std::uint16_t> cells_;
  std::span<Run> runs_;
  std::span<Stats> stats_;
  std::span<std::uint8_t> number_;  // by root
  FixedVector<std::uint16_t, kMaxSelected> selected_;
  std::size_t run_count_ = 0;
  std::uint32_t refused_ = 0;
};

}  // namespace st
