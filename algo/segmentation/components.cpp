#include "algo/segmentation/components.hpp"

#include <cstring>
#include <utility>

namespace st {
namespace {

// cm^2 of a cell of weight 1 (2^32 / q^2): its side is step z / f, and z = K / q.
double cm2_of_weight(const DepthTables& tables, int step) {
  const Intrinsics& camera = tables.calibration().depth;
  const double k = tables.codes_per_inverse_m() * step;
  return 1e4 * k * k / (camera.fx * camera.fy) / 4294967296.0;
}

}  // namespace

float Components::area_cm2(int number, const DepthTables& tables, int step) const {
  return static_cast<float>(static_cast<double>(selected(number).weighted) * cm2_of_weight(tables, step));
}

std::uint64_t Components::weighted_of_area(float area_cm2, const DepthTables& tables, int step) const {
  return static_cast<std::uint64_t>(static_cast<double>(area_cm2) / cm2_of_weight(tables, step));
}

void Components::bind(Bump& memory, int grid_width, int grid_height) {
  width_ = grid_width;
  height_ = grid_height;
  cells_ = memory.take<std::uint16_t>(static_cast<std::size_t>(grid_width) *
                                      static_cast<std::size_t>(grid_height));
  runs_ = memory.take<Run>(kMaxRuns);
  stats_ = memory.take<Stats>(kMaxRuns);
  number_ = memory.take<std::uint8_t>(kMaxRuns);
}

ImageView<std::uint16_t> Components::begin() {
  std::memset(cells_.data(), 0, cells_.size_bytes());
  run_count_ = 0;
  refused_ = 0;
  return {cells_.data(), width_, height_};
}

void Components::push_run(int v, int u0, int u1) {
  if (run_count_ == runs_.size()) {
    ++refused_;
    return;
  }
  const std::uint16_t* row = cells_.data() + static_cast<std::ptrdiff_t>(v) * width_;
  Stats s{static_cast<std::uint32_t>(u1 - u0), 0};
  for (int u = u0; u < u1; ++u) s.weighted += 0xFFFFFFFFu / (static_cast<std::uint32_t>(row[u]) * row[u]);
  stats_[run_count_] = s;
  runs_[run_count_] = {static_cast<std::int16_t>(v), static_cast<std::int16_t>(u0),
                       static_cast<std::int16_t>(u1), static_cast<std::uint16_t>(run_count_)};
  ++run_count_;
}

void Components::extract_runs(int gap_steepness) {
  for (int v = 0; v < height_; ++v) {
    const std::uint16_t* row = cells_.data() + static_cast<std::ptrdiff_t>(v) * width_;
    int u = 0;
    while (u < width_) {
      if (row[u] == 0) {
        std::uint64_t four = 0;
        if (u + 4 <= width_) std::memcpy(&four, row + u, sizeof four);
        u += u + 4 <= width_ && four == 0 ? 4 : 1;
        continue;
      }
      const int u0 = u++;
      while (u < width_ && row[u] != 0 && together(row[u], row[u - 1], gap_steepness)) ++u;
      push_run(v, u0, u);
    }
  }
}

// Path halving; a root's index never exceeds that of its members.
std::uint16_t Components::find(std::uint16_t run) {
  while (runs_[run].root != run) {
    runs_[run].root = runs_[runs_[run].root].root;
    run = runs_[run].root;
  }
  return run;
}

void Components::unite(std::uint16_t a, std::uint16_t b) {
  const std::uint16_t ra = find(a), rb = find(b);
  if (ra == rb) return;
  const std::uint16_t root = ra < rb ? ra : rb, child = ra < rb ? rb : ra;
  runs_[child].root = root;
  stats_[root].cells += stats_[child].cells;
  stats_[root].weighted += stats_[child].weighted;
}

bool Components::touch(const Run& above, const Run& below, int gap_steepness) const {
  const std::uint16_t* up = cells_.data() + static_cast<std::ptrdiff_t>(above.v) * width_;
  const std::uint16_t* down = cells_.data() + static_cast<std::ptrdiff_t>(below.v) * width_;
  for (int u = below.u0; u < below.u1; ++u) {
    const int first = u - 1 > above.u0 ? u - 1 : above.u0, last = u + 1 < above.u1 - 1 ? u + 1 : above.u1 - 1;
    for (int w = first; w <= last; ++w)
      if (together(up[w], down[u], gap_steepness)) return true;
  }
  return false;
}

void Components::link_rows(int gap_steepness) {
  std::size_t above = 0, row_begin = 0;
  for (std::size_t i = 0; i < run_count_; ++i) {
    const Run& run = runs_[i];
    if (i > 0 && runs_[i - 1].v != run.v) row_begin = i;
    if (i == row_begin) {  // first run of its row: move on to the row above's first run
      while (above < row_begin && runs_[above].v < run.v - 1) ++above;
    }
    // Runs above that end left of this one cannot meet a later one either.
    while (above < row_begin && runs_[above].u1 < run.u0) ++above;
    for (std::size_t k = above; k < row_begin && runs_[k].u0 <= run.u1; ++k)
      if (touch(runs_[k], run, gap_steepness))
        unite(static_cast<std::uint16_t>(k), static_cast<std::uint16_t>(i));
  }
}

void Components::label(int gap_steepness) {
  extract_runs(gap_steepness);
  link_rows(gap_steepness);
  for (std::size_t i = 0; i < run_count_; ++i) runs_[i].root = find(static_cast<std::uint16_t>(i));
}

int Components::select(std::uint32_t least_cells, std::uint64_t least_weighted, int most) {
  const auto capacity = static_cast<std::size_t>(most < kMaxSelected ? most : kMaxSelected);
  selected_.clear();
  for (std::size_t i = 0; i < run_count_; ++i) {
    number_[i] = 0;
    if (runs_[i].root != i || stats_[i].cells < least_cells || stats_[i].weighted < least_weighted) continue;
    if (selected_.size() == capacity) {
      if (stats_[selected_[capacity - 1]].weighted >= stats_[i].weighted) continue;
      selected_.pop_back();
    }
    selected_.push_back(static_cast<std::uint16_t>(i));
    for (std::size_t k = selected_.size() - 1; k > 0; --k) {  // insertion keeps reading order among equals
      if (stats_[selected_[k - 1]].weighted >= stats_[selected_[k]].weighted) break;
      std::swap(selected_[k - 1], selected_[k]);
    }
  }
  for (std::size_t k = 0; k < selected_.size(); ++k) number_[selected_[k]] = static_cast<std::uint8_t>(k + 1);
  return static_cast<int>(selected_.size());
}

}  // namespace st
