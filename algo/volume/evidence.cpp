#include "algo/volume/evidence.hpp"

#include <cstring>

#include "algo/volume/evidence_kernel.hpp"

namespace st {
namespace {

constexpr int up(int n, int to) { return (n + to - 1) / to * to; }
constexpr std::size_t area(int w, int h) { return static_cast<std::size_t>(w) * static_cast<std::size_t>(h); }

DepthCell merged(const DepthCell& a, const DepthCell& b) {
  return {a.nearest < b.nearest ? a.nearest : b.nearest, a.farthest > b.farthest ? a.farthest : b.farthest,
          a.empty_to > b.empty_to ? a.empty_to : b.empty_to};
}

// Slopes are fitted over more pixels where a Kinect's steps are taller than a pixel is wide.
int reach_at(float z_m) { return z_m < 1.0f ? 4 : z_m < 1.8f ? 6 : Evidence::kReach; }

}  // namespace

void Evidence::bind(Bump& memory, int max_width, int max_height) {
  const int w = up(max_width, kCell), h = up(max_height, kCell);
  z = memory.take<float>(area(w, h) + kPad);
  meta = memory.take<std::uint32_t>(area(w, h) + kPad);
  padded_ = memory.take<float>(area(w + 2 * kReach + kPad, max_height + 2 * kReach));
  std::size_t cells = 0;
  for (int level = 0; level < kLevels; ++level) cells += area((w >> (3 + level)) + 2, (h >> (3 + level)) + 2);
  cells_ = memory.take<DepthCell>(cells);
}

void Evidence::copy_padded(const EvidenceInput& input) {
  padded_stride_ = roi.width() + 2 * kReach + kPad;
  const Rect from = roi.grown(kReach).clipped(input.depth_m.width, input.depth_m.height);
  const std::size_t width = static_cast<std::size_t>(from.width());
  for (int v = roi.v0 - kReach; v < roi.v1 + kReach; ++v) {
    float* to = padded_.data() + static_cast<std::ptrdiff_t>(v - roi.v0 + kReach) * padded_stride_;
    std::memset(to, 0, static_cast<std::size_t>(padded_stride_) * sizeof(float));
    if (v < from.v0 || v >= from.v1) continue;
    std::memcpy(to + (from.u0 - roi.u0 + kReach), input.depth_m.row(v) + from.u0, width * sizeof(float));
  }
}

void Evidence::evaluate(const EvidenceInput& input, const NoiseWeights& noise, const Pose& T_camera_object,
                        const Vec3f& box_low, const Vec3f& box_high) {
  roi = input.roi.clipped(input.depth_m.width, input.depth_m.height);
  surface_pixels = refused_pixels = outside_pixels = 0;
  stride = up(roi.width(), kCell);
  if (roi.empty()) {
    roi = {0, 0, 0, 0};
    levels_[kLevels - 1].first = 0;
    cells_[0] = {};
    low = {1e9f, 1e9f, 1e9f};
    high = -low;
    return;
  }
  copy_padded(input);
  const PoseF T = to_float(T_camera_object.inverse());
  const Vec3f middle = to_float(T_camera_object) * ((box_low + box_high) * 0.5f);
  EvidenceKernel k{};
  k.depth = padded_.data() + static_cast<std::ptrdiff_t>(kReach) * padded_stride_ + kReach;
  k.depth_stride = padded_stride_;
  k.owners = input.owners.empty() ? nullptr : input.owners.row(roi.v0) + roi.u0;
  k.owners_stride = input.owners.width;
  k.object = input.object;
  k.background = input.background;
  k.width = roi.width();
  k.height = roi.height();
  k.fx = input.camera.fx;
  k.fy = input.camera.fy;
  k.cx = input.camera.cx - static_cast<float>(roi.u0);
  k.cy = input.camera.cy - static_cast<float>(roi.v0);
  k.wide = reach_at(middle.z);
  k.noise_aware = noise.noise_aware;
  k.sigma_floor = noise.sigma_floor_m;
  k.sigma_quadratic = noise.sigma_quadratic;
  k.nominal_sigma = sigma_z_m(noise, noise.nominal_m);
  std::memcpy(k.R, T.R.m, sizeof k.R);
  for (int a = 0; a < 3; ++a) {
    k.t[a] = T.t[a];
    k.low[a] = box_low[a];
    k.high[a] = box_high[a];
    k.seen_low[a] = 1e9f;
    k.seen_high[a] = -1e9f;
  }
  k.stride = stride;
  k.z = z.data();
  k.meta = meta.data();
  evaluate_pixels(k);
  surface_pixels = k.surface;
  refused_pixels = k.refused;
  outside_pixels = k.outside;
  low = {k.seen_low[0], k.seen_low[1], k.seen_low[2]};
  high = {k.seen_high[0], k.seen_high[1], k.seen_high[2]};
  fill_cells();
}

void Evidence::fill_cells() {
  static_assert(sizeof(DepthCell) == 3 * sizeof(float), "the kernel writes cells as triples");
  levels_[0] = {stride / kCell, up(roi.height(), kCell) / kCell, 0};
  reduce_cells(z.data(), meta.data(), stride, roi.height(), levels_[0].width, &cells_[0].nearest);
  for (int level = 1; level < kLevels; ++level) {
    const Level& fine = levels_[level - 1];
    Level& coarse = levels_[level];
    coarse = {(fine.width + 1) / 2, (fine.height + 1) / 2, fine.first + area(fine.width, fine.height)};
    for (int v = 0; v < coarse.height; ++v)
      for (int u = 0; u < coarse.width; ++u) {
        DepthCell all;
        for (int y = 2 * v; y < 2 * v + 2 && y < fine.height; ++y)
          for (int x = 2 * u; x < 2 * u + 2 && x < fine.width; ++x)
            all = merged(all, cells_[fine.first + area(fine.width, y) + static_cast<std::size_t>(x)]);
        cells_[coarse.first + area(coarse.width, v) + static_cast<std::size_t>(u)] = all;
      }
  }
}

Evidence::Answer Evidence::ask(const Rect& rect, float near_m, float far_m, float reach_m) const {
  const Rect r = rect.clipped(roi.width(), roi.height());
  Answer answer;
  if (r.empty()) return answer;
  int level = 0, shift = 3;
  while (level + 1 < kLevels &&
         (((r.u1 - 1) >> shift) - (r.u0 >> shift) > 2 || ((r.v1 - 1) >> shift) - (r.v0 >> shift) > 2)) {
    ++level;
    ++shift;
  }
  const Level& l = levels_[level];
  for (int v = r.v0 >> shift; v <= (r.v1 - 1) >> shift; ++v)
    for (int u = r.u0 >> shift; u <= (r.u1 - 1) >> shift; ++u) {
      const DepthCell& c = cells_[l.first + area(l.width, v) + static_cast<std::size_t>(u)];
      if (c.nearest - reach_m <= far_m && c.farthest + reach_m >= near_m) {
        answer.surface = true;
        if (c.nearest - reach_m < answer.near_m) answer.near_m = c.nearest - reach_m;
        if (c.farthest + reach_m > answer.far_m) answer.far_m = c.farthest + reach_m;
      }
      answer.empties = answer.empties || c.empty_to >= near_m;
    }
  return answer;
}

}  // namespace st
