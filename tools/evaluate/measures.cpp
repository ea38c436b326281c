#include "tools/evaluate/measures.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kDegrees = 180 / kPi;

// As numpy does it: linear between neighbours. `sorted` is not empty.
double percentile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const std::size_t below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (at - static_cast<double>(below));
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> associate(std::span<const double> truth_t,
                                                           std::span<const double> estimate_t) {
  constexpr double kLongestS = 0.020;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (truth_t.empty() || estimate_t.empty()) return pairs;
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (std::size_t i = 0; i < truth_t.size(); ++i) {
    const auto after = std::ranges::lower_bound(estimate_t, truth_t[i]);
    const std::size_t k = static_cast<std::size_t>(after - estimate_t.begin());
    for (const std::size_t j : {std::max<std::size_t>(k, 1) - 1, std::min(k, estimate_t.size() - 1)}) {
      const double d = std::fabs(estimate_t[j] - truth_t[i]);
      if (d <= kLongestS) candidates.emplace_back(d, i, j);
    }
  }
  std::ranges::sort(candidates);
  std::vector<bool> truth_used(truth_t.size()), estimate_used(estimate_t.size());
  for (const auto& [d, i, j] : candidates) {
    if (truth_used[i] || estimate_used[j]) continue;
    truth_used[i] = estimate_used[j] = true;
    pairs.emplace_back(i, j);
  }
  std::ranges::sort(pairs);
  return pairs;
}

EvaluationJson statistics(std::vector<double> values, double scale) {
  if (values.empty()) return nullptr;
  double sum = 0, square = 0;
  for (double& v : values) {
    v *= scale;
    sum += v;
    square += v * v;
  }
  const double n = static_cast<double>(values.size());
  std::ranges::sort(values);
  return {{"rmse", std::sqrt(square / n)},
          {"mean", sum / n},
          {"median", percentile(values, 0.5)},
          {"p95", percentile(values, 0.95)},
          {"max", values.back()}};
}

EvaluationJson relative_error(std::span<const double> t, std::span<const Pose> estimate,
                              std::span<const Pose> truth) {
  constexpr double kDeltaS = 1.0, kToleranceS = 0.06;
  std::vector<double> translation, rotation;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::size_t j = static_cast<std::size_t>(std::ranges::lower_bound(t, t[i] + kDeltaS) - t.begin());
    std::size_t best = 0;
    for (const std::size_t k : {j - 1, j}) {
      if (k <= i || k >= t.size()) continue;
      const double off = std::fabs(t[k] - t[i] - kDeltaS);
      if (off <= kToleranceS && (best == 0 || off < std::fabs(t[best] - t[i] - kDeltaS))) best = k;
    }
    if (best == 0) continue;
    const Pose E = (truth[i].inverse() * truth[best]).inverse() * (estimate[i].inverse() * estimate[best]);
    translation.push_back(norm(E.t));
    rotation.push_back(rotation_angle(E.R));
  }
  const std::size_t count = translation.size();
  return {{"pairs", count},
          {"trans_mm", statistics(std::move(translation), 1e3)},
          {"rot_deg", statistics(std::move(rotation), kDegrees)}};
}

EvaluationJson gaps(std::span<const double> t, const std::vector<bool>& have, const std::vector<bool>& live) {
  const std::size_t n = t.size();
  std::size_t first_live = n, last_live = 0, first = n, live_count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!live[i]) continue;
    ++live_count;
    first_live = std::min(first_live, i);
    last_live = i;
    if (have[i]) first = std::min(first, i);
  }
  if (first == n)
    return {{"count", live_count > 0 ? 1 : 0},
            {"longest_s", live_count > 0 ? t[last_live] - t[first_live] : 0.0},
            {"before_first_s", nullptr},
            {"frames", live_count}};
  std::size_t count = 0, frames = 0;
  double longest = 0, before_s = 0;
  bool inside = false;
  for (std::size_t i = first; i < n; ++i) {
    const bool missing = live[i] && !have[i];
    if (missing && !inside) {
      inside = true;
      ++count;
      before_s = i > 0 ? t[i - 1] : t[i];
    }
    if (missing) {
      ++frames;
      longest = std::max(longest, t[i] - before_s);
    }
    if (have[i] || !live[i]) inside = false;
  }
  return {{"count", count},
          {"frames", frames},
          {"longest_s", longest},
          {"before_first_s", t[first] - t[first_live]}};
}

double way_length(std::span<const Pose> poses) {
  double length = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) length += norm(poses[i].t - poses[i - 1].t);
  return length;
}

}  // namespace st
