#include "algo/control/wheel_fit.hpp"

#include <cmath>

#include "algo/control/lag_search.hpp"
#include "algo/control/wheel_motion.hpp"
#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kWindow_s = 0.5, kLongestGap_s = 0.12;
constexpr int kRounds = 4;
constexpr double kTrim = 3.0, kLeastTrim_rad = 0.01;  // windows further off than so many RMS are left out
constexpr double kLeastTurn_rad = 3.0, kLeastWay_m = 1.0;
constexpr double kWorstSigma = 0.02;

// What the wheels had rolled at a time. False where it is not known.
bool rolled_at(std::span<const WheelMark> marks, double t_s, WheelMark& out) {
  if (marks.size() < 2 || t_s < marks.front().t_s || t_s > marks.back().t_s) return false;
  std::size_t low = 0, high = marks.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (marks[middle].t_s <= t_s ? low : high) = middle;
  }
  const WheelMark &a = marks[low], &b = marks[high];
  const double span_s = b.t_s - a.t_s;
  if (span_s > kLongestGap_s) return false;
  const double share = span_s > 0 ? (t_s - a.t_s) / span_s : 1.0;
  out = {t_s, a.left_m + share * (b.left_m - a.left_m), a.right_m + share * (b.right_m - a.right_m)};
  return true;
}

std::size_t fill(std::span<const PlanarSample> base, std::span<const WheelMark> marks, double lag_s,
                 std::span<FitWindow> windows) {
  std::size_t n = 0, begin = 0;
  BodyMotion motion;
  for (std::size_t i = 1; i < base.size() && n < windows.size(); ++i) {
    const PlanarSample &p = base[i - 1], &q = base[i];
    if (q.t_s - p.t_s > kLongestGap_s) {
      begin = i;
      motion = {};
      continue;
    }
    motion.add({p.x_m, p.y_m, p.yaw_rad}, {q.x_m, q.y_m, q.yaw_rad});
    if (q.t_s - base[begin].t_s < kWindow_s) continue;
    WheelMark from, until;
    if (rolled_at(marks, base[begin].t_s - lag_s, from) && rolled_at(marks, q.t_s - lag_s, until))
      windows[n++] = {until.left_m - from.left_m, until.right_m - from.right_m, motion.x_m, motion.turn_rad,
                      true};
    begin = i;
    motion = {};
  }
  return n;
}

struct Turns {  // a = alpha R - beta L
  double alpha = 0, beta = 0, sigma = 0, rms = 0;
  bool valid = false;
};

Turns fit_turns(std::span<const FitWindow> windows) {
  double rr = 0, rl = 0, ll = 0, ra = 0, la = 0;
  int n = 0;
  for (const FitWindow& w : windows) {
    if (!w.used) continue;
    rr += w.right_m * w.right_m, rl += w.right_m * w.left_m, ll += w.left_m * w.left_m;
    ra += w.right_m * w.turn_rad, la += w.left_m * w.turn_rad;
    ++n;
  }
  Turns fit;
  const double det = rr * ll - rl * rl;
  if (n < 8 || !(det > 0)) return fit;
  fit.alpha = (ll * ra - rl * la) / det;
  fit.beta = (rl * ra - rr * la) / det;
  double square = 0;
  for (const FitWindow& w : windows) {
    const double e = w.turn_rad - fit.alpha * w.right_m + fit.beta * w.left_m;
    square += w.used ? e * e : 0;
  }
  fit.rms = std::sqrt(square / n);
  const double worse = rr > ll ? rr : ll;
  fit.sigma = fit.rms * std::sqrt(worse / det);
  fit.valid = fit.alpha > 0 && fit.beta > 0;
  return fit;
}

WheelFit fit_at(std::span<const PlanarSample> base, std::span<const WheelMark> marks, double lag_s,
                std::span<FitWindow> memory) {
  WheelFit fit;
  fit.lag_s = lag_s;
  const std::span<FitWindow> windows = memory.first(fill(base, marks, lag_s, memory));
  Turns turns;
  for (int round = 0; round < kRounds; ++round) {
    turns = fit_turns(windows);
    if (!turns.valid) return fit;
    const double most = kTrim * turns.rms > kLeastTrim_rad ? kTrim * turns.rms : kLeastTrim_rad;
    for (FitWindow& w : windows)
      w.used = std::fabs(w.turn_rad - turns.alpha * w.right_m + turns.beta * w.left_m) < most;
  }
  double pd = 0, pp = 0;  // d = b p, p = (alpha R + beta L) / 2
  for (const FitWindow& w : windows) {
    if (!w.used) continue;
    const double p = 0.5 * (turns.alpha * w.right_m + turns.beta * w.left_m);
    pd += p * w.forward_m;
    pp += p * p;
    fit.way_m += std::fabs(w.forward_m);
    fit.turn_rad += std::fabs(w.turn_rad);
  }
  if (!(pp > 0)) return fit;
  fit.wheel_base_m = pd / pp;
  fit.right_scale = turns.alpha * fit.wheel_base_m;
  fit.left_scale = turns.beta * fit.wheel_base_m;
  fit.sigma_scale = turns.sigma * fit.wheel_base_m;
  fit.sigma_base_m = fit.sigma_scale * fit.wheel_base_m;
  fit.misfit_rad = turns.rms;
  fit.valid = fit.wheel_base_m > 0 && fit.sigma_scale < kWorstSigma && fit.way_m > kLeastWay_m &&
              fit.turn_rad > kLeastTurn_rad;
  return fit;
}

}  // namespace

WheelFit fit_wheels(std::span<const PlanarSample> base, std::span<const WheelMark> marks,
                    std::span<FitWindow> memory) {
  return best_lag([&](double lag_s) { return fit_at(base, marks, lag_s, memory); },
                  [](const WheelFit& a, const WheelFit& b) {
                    return a.valid && (!b.valid || a.misfit_rad < b.misfit_rad);
                  });
}

}  // namespace st
