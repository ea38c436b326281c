#include "algo/tracking/places.hpp"

#include <cmath>

namespace st {
namespace {

constexpr double kNear_m = 0.15, kNear_rad = 0.2;
constexpr float kNoMatch = 1e9f;

}  // namespace

Thumbnail thumbnail_of(ImageView<const float> z) {
  constexpr int kLeastReadings = 4;  // a sixteenth of a block of 8 x 8
  Thumbnail out;
  const int wide = z.width / Thumbnail::kAcross, high = z.height / Thumbnail::kDown;
  for (int y = 0; y < Thumbnail::kDown; ++y)
    for (int x = 0; x < Thumbnail::kAcross; ++x) {
      float sum = 0;
      int readings = 0;
      for (int v = y * high; v < (y + 1) * high; ++v)
        for (int u = x * wide; u < (x + 1) * wide; ++u) {
          if (!(z(u, v) > 0)) continue;
          sum += 1.0f / z(u, v);
          ++readings;
        }
      if (readings >= kLeastReadings)
        out.inverse_depth[y * Thumbnail::kAcross + x] = sum / static_cast<float>(readings);
    }
  return out;
}

float difference(const Thumbnail& a, const Thumbnail& b) {
  float sum = 0;
  int shared = 0;
  for (int i = 0; i < Thumbnail::kBlocks; ++i) {
    if (!(a.inverse_depth[i] > 0 && b.inverse_depth[i] > 0)) continue;
    sum += std::fabs(a.inverse_depth[i] - b.inverse_depth[i]);
    ++shared;
  }
  return 3 * shared >= Thumbnail::kBlocks ? sum / static_cast<float>(shared) : kNoMatch;
}

void Places::remember(const Pose& T, ImageView<const float> depth_z) {
  for (std::size_t i = 0; i < size_; ++i) {
    const Pose& kept = places_[i].T_world_camera;
    if (norm(kept.t - T.t) < kNear_m && rotation_angle(kept.R.transposed() * T.R) < kNear_rad) return;
  }
  places_[next_] = {T, thumbnail_of(depth_z)};
  next_ = (next_ + 1) % kMost;
  if (size_ < kMost) ++size_;
}

Places::Match Places::like(const Thumbnail& seen, std::size_t rank) const {
  // Selection by counting: no list to sort, and ties go to the older one.
  Match best{Pose{}, kNoMatch};
  float found[kMost];
  for (std::size_t i = 0; i < size_; ++i) found[i] = difference(places_[i].seen, seen);
  for (std::size_t i = 0; i < size_; ++i) {
    std::size_t before = 0;
    for (std::size_t j = 0; j < size_; ++j)
      before += found[j] < found[i] || (found[j] == found[i] && j < i) ? 1u : 0u;
    if (before == rank) best = {places_[i].T_world_camera, found[i]};
  }
  return best;
}

}  // namespace st
