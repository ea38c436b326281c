#include "algo/tracking/way_match.hpp"

#include <cmath>
#include <initializer_list>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kWindow_s = 0.5;
constexpr double kLeastWay_m = 0.12;  // root of the summed squares of the windows' ways
constexpr double kMostMisfit = 0.3;   // of them; slip, and an origin beside the turning centre
constexpr double kForget = 0.97;      // a window: half a minute

}  // namespace

void WayMatch::begin_frame(const WheelOdometry& wheels) {
  if (closes_ || !wheels.valid) {
    ++window_;
    base_ = {};
    passed_s_ = 0;
  }
  closes_ = false;
  if (!wheels.valid) return;
  const SinCos middle = sin_cos(base_.yaw + 0.5 * wheels.turn_rad);
  base_.x += middle.cos * wheels.forward_m;
  base_.y += middle.sin * wheels.forward_m;
  base_.yaw += wheels.turn_rad;
  passed_s_ += wheels.dt_s;
  closes_ = passed_s_ >= kWindow_s;
}

void WayMatch::add(int id, double x_m, double y_m) {
  Entry* entry = nullptr;
  for (Entry& known : entries_)
    if (known.id == id) entry = &known;
  if (entry == nullptr && entries_.push_back({})) entry = &entries_[entries_.size() - 1];
  if (entry == nullptr) {  // the one that has not been seen for longest gives way
    entry = &entries_[0];
    for (Entry& old : entries_)
      if (old.window < entry->window) entry = &old;
  }
  if (entry->id != id) *entry = {id, 0, 0, -1, 0, 0};
  if (closes_ && entry->window == window_) {
    const double x = x_m - entry->x_m, y = y_m - entry->y_m;
    const double seen_m = std::sqrt(x * x + y * y), told_m = std::sqrt(base_.x * base_.x + base_.y * base_.y);
    entry->told2 = kForget * entry->told2 + told_m * told_m;
    entry->misfit2 = kForget * entry->misfit2 + (seen_m - told_m) * (seen_m - told_m);
  }
  if (!closes_) return;
  entry->window = window_ + 1;  // the next one begins here, for whoever is seen
  entry->x_m = x_m;
  entry->y_m = y_m;
}

// An object that is in sight comes before those that were: a robot that was lost may be back under another
// number.
int WayMatch::best() const {
  for (const bool fresh : {true, false}) {
    int best = 0, matches = 0;
    for (const Entry& entry : entries_) {
      if ((entry.window >= window_) != fresh || entry.told2 < kLeastWay_m * kLeastWay_m) continue;
      if (entry.misfit2 > kMostMisfit * kMostMisfit * entry.told2) continue;
      best = entry.id;
      ++matches;
    }
    if (matches > 0) return matches == 1 ? best : 0;
  }
  return 0;
}

}  // namespace st
