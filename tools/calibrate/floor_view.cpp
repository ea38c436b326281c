#include "tools/calibrate/floor_view.hpp"

#include <cmath>

#include "algo/depth/preprocess.hpp"
#include "algo/segmentation/background.hpp"

namespace st {
namespace {

constexpr double kNotFloor = 1e6;

}  // namespace

FloorView::FloorView(const Calibration& calibration)
    : memory_([&](Bump& memory) { tables_.bind(memory, calibration); }) {
  tables_.configure(calibration);
  const auto pixels = static_cast<std::size_t>(tables_.width()) * static_cast<std::size_t>(tables_.height());
  code_.resize(pixels);
  stored_.resize(pixels);
  sum_.resize(pixels);
  count_.resize(pixels);
}

void FloorView::add(const FrameInput& frame) {
  const int width = tables_.width(), height = tables_.height();
  preprocess(tables_, frame.depth, {code_.data(), width, height}, {stored_.data(), width, height});
  for (std::size_t i = 0; i < code_.size(); ++i) {
    sum_[i] += code_[i];
    count_[i] += code_[i] > 0 ? 1u : 0u;
  }
  if (frame.has_gravity) {
    gravity_ += frame.gravity_mps2;
    ++gravity_frames_;
  }
  ++frames_;
}

double FloorView::mean(int u, int v) const {
  const auto pixel = static_cast<std::size_t>(v * tables_.width() + u);
  if (2 * count_[pixel] < static_cast<std::uint32_t>(frames_) || count_[pixel] == 0) return 0;
  return static_cast<double>(sum_[pixel]) / count_[pixel];
}

Floor FloorView::find_floor() {
  FloorFinder finder;
  const HeapMemory memory([&](Bump& bump) { finder.bind(bump); });
  for (int v = 0; v < tables_.height(); ++v)
    for (int u = 0; u < tables_.width(); ++u)
      stored_[static_cast<std::size_t>(v * tables_.width() + u)] =
          static_cast<std::uint16_t>(std::lround(mean(u, v) * Background::kUnit));
  return finder.find(tables_, {stored_.data(), tables_.width(), tables_.height()}, has_gravity(), gravity_);
}

// A line through the residuals along each axis; the patch's pixels lie evenly round its centre.
double FloorView::patch_offset(const Floor& floor, int column, int row) const {
  constexpr double kSteepest = 0.5;  // codes a pixel: walls have some, a bow a quarter
  constexpr int kLeast = kFloorPatch_px * kFloorPatch_px / 2;
  double sum = 0, sum_u = 0, sum_v = 0, square = 0;
  int known = 0;
  for (int y = 0; y < kFloorPatch_px; ++y) {
    for (int x = 0; x < kFloorPatch_px; ++x) {
      const int u = column * kFloorPatch_px + x, v = row * kFloorPatch_px + y;
      const double code = mean(u, v);
      if (code == 0) continue;
      const double residual = code - static_cast<double>(floor.codes.at(u, v));
      const double du = x - 0.5 * (kFloorPatch_px - 1), dv = y - 0.5 * (kFloorPatch_px - 1);
      sum += residual, sum_u += du * residual, sum_v += dv * residual, square += du * du;
      ++known;
    }
  }
  if (known < kLeast) return kNotFloor;
  const bool as_steep = std::fabs(sum_u) < kSteepest * square && std::fabs(sum_v) < kSteepest * square;
  return as_steep ? sum / known : kNotFloor;
}

std::vector<bool> FloorView::floor_patches(const Floor& floor) const {
  constexpr double kSurely_codes = 8, kApart_codes = 6;  // a bow between neighbours is less
  const int columns = tables_.width() / kFloorPatch_px, rows = tables_.height() / kFloorPatch_px;
  std::vector<double> offset;
  std::vector<int> open;
  for (int i = 0; i < columns * rows; ++i) {
    offset.push_back(patch_offset(floor, i % columns, i / columns));
    if (std::fabs(offset.back()) < kSurely_codes) open.push_back(i);
  }
  std::vector<bool> taken(offset.size());
  for (const int i : open) taken[static_cast<std::size_t>(i)] = true;
  while (!open.empty()) {
    const int at = open.back();
    open.pop_back();
    constexpr int kBeside[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    for (const auto& [dx, dy] : kBeside) {
      const int x = at % columns + dx, y = at / columns + dy;
      if (x < 0 || y < 0 || x >= columns || y >= rows) continue;
      const auto next = static_cast<std::size_t>(y * columns + x), here = static_cast<std::size_t>(at);
      if (taken[next] || !(std::fabs(offset[next] - offset[here]) < kApart_codes)) continue;
      taken[next] = true;
      open.push_back(static_cast<int>(next));
    }
  }
  return taken;
}

std::vector<FloorSample> FloorView::samples(const Floor& floor) const {
  const std::vector<bool> taken = floor_patches(floor);
  const int columns = tables_.width() / kFloorPatch_px, rows = tables_.height() / kFloorPatch_px;
  std::vector<FloorSample> out;
  for (int v = 0; v < rows * kFloorPatch_px; v += 2) {
    for (int u = 0; u < columns * kFloorPatch_px; u += 2) {
      if (!taken[static_cast<std::size_t>(v / kFloorPatch_px * columns + u / kFloorPatch_px)]) continue;
      if (const double code = mean(u, v); code > 0) out.push_back({u, v, code + tables_.code_offset()});
    }
  }
  return out;
}

}  // namespace st
