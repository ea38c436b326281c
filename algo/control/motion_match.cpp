#include "algo/control/motion_match.hpp"

#include <cmath>

namespace st {
namespace {

constexpr double kWindow_s = 0.5, kSigma_m = 0.004;
constexpr double kGain = 0.3, kTurnSigma_rad = 0.04;  // as large as believed; noise of a window's turn
constexpr int kLeastWindows = 4;
constexpr double kLeastTotal = 100;       // squares in sigmas: something has moved by more than noise
constexpr double kLeastExplained = 0.75;  // wheels slip, and the tracker is not always right

}  // namespace

// A window's sums, whether anything moved or not: an object that moves while the robot stands is none.
void MotionMatch::add_to(Entry& entry, const WheelOdometry& wheels, const SeenObject& object) {
  const bool good = object.good && object.has_heading, whole = entry.seen && good && wheels.valid;
  if (whole) {
    entry.window.add(entry.pose, object.pose);
    entry.forward_m += wheels.forward_m;
    entry.turn_rad += wheels.turn_rad;
    entry.duration_s += wheels.dt_s;
  }
  if (whole && entry.duration_s >= kWindow_s) {
    entry.regression.add(entry.forward_m, entry.turn_rad, entry.window, kSigma_m);
    const double misfit = entry.window.turn_rad - entry.turn_rad;
    entry.turn_square += entry.turn_rad * entry.turn_rad;
    entry.turn_misfit += misfit * misfit;
  }
  if (!whole || entry.duration_s >= kWindow_s) {
    entry.window = {};
    entry.forward_m = entry.turn_rad = entry.duration_s = 0;
  }
  entry.seen = good;
  entry.pose = object.pose;
  entry.guess = object.guess;
}

void MotionMatch::add(const WheelOdometry& wheels, const SeenObjects& objects) {
  for (const SeenObject& object : objects) {
    if (object.id == 0) continue;
    Entry* known = nullptr;
    for (Entry& entry : entries_)
      if (entry.id == object.id) known = &entry;
    if (known == nullptr && !entries_.push_back({object.id, false, {}, {}, 0, 0, 0, {}, 0, 0, {}})) continue;
    add_to(known != nullptr ? *known : entries_[entries_.size() - 1], wheels, object);
  }
}

int MotionMatch::best() const {
  int id = 0;
  double most = 0;
  for (const Entry& entry : entries_) {
    const double total = entry.regression.total();
    if (entry.regression.rows() < kLeastWindows || total < kLeastTotal) continue;
    const BaseFit fit = entry.regression.fit(entry.guess);
    const double explained = total - entry.regression.residual(fit);
    const double turn_noise = entry.regression.rows() * kTurnSigma_rad * kTurnSigma_rad;
    if (!fit.valid || std::fabs(fit.gain - 1) > kGain || explained < kLeastExplained * total) continue;
    if (entry.turn_misfit > (1 - kLeastExplained) * entry.turn_square + turn_noise) continue;
    if (explained < most) continue;
    most = explained;
    id = entry.id;
  }
  return id;
}

}  // namespace st
