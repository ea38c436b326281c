#include "algo/recognition/upright_fit.hpp"

namespace st {
namespace {

struct Pair {
  Vec3 a, b;
};

// cos and sin of the turn, and the shift: p_b = R p_a + t.
struct Motion {
  double c = 1, s = 0;
  Vec3 t{};

  Vec3 operator()(const Vec3& p) const {
    return {c * p.x - s * p.y + t.x, s * p.x + c * p.y + t.y, p.z + t.z};
  }
};

// Least squares over weighted pairs: the turn that aligns the horizontal offsets from the means (Horn's
// closed form in the plane).
template <typename Used>
bool fit(std::span<const Pair> pairs, const Used& used, Motion& motion) {
  Vec3 mean_a{}, mean_b{};
  int n = 0;
  for (const Pair& p : pairs)
    if (used(p)) mean_a += p.a, mean_b += p.b, ++n;
  if (n < 2) return false;
  mean_a = mean_a * (1.0 / n);
  mean_b = mean_b * (1.0 / n);
  double along = 0, across = 0;
  for (const Pair& p : pairs) {
    if (!used(p)) continue;
    const Vec3 a = p.a - mean_a, b = p.b - mean_b;
    along += a.x * b.x + a.y * b.y;
    across += a.x * b.y - a.y * b.x;
  }
  const double length = std::sqrt(along * along + across * across);
  if (!(length > 0)) return false;
  motion = {along / length, across / length, {}};
  motion.t = mean_b - motion(mean_a);
  return true;
}

}  // namespace

UprightFit fit_upright(const FeatureSet& a, const FeatureSet& b, const Matches& matches, float tolerance_m) {
  constexpr double kLeastBase_m = 0.03;
  constexpr int kLeastInliers = 3;
  Pair storage[kMaxFeatures];
  std::uint32_t distances[kMaxFeatures];
  std::size_t n = 0;
  for (const Match& m : matches) {  // the nearest first
    std::size_t i = n++;
    for (; i > 0 && distances[i - 1] > m.squared_distance; --i) {
      distances[i] = distances[i - 1];
      storage[i] = storage[i - 1];
    }
    distances[i] = m.squared_distance;
    storage[i] = {to_double(a.features[static_cast<std::size_t>(m.a)].p_m),
                  to_double(b.features[static_cast<std::size_t>(m.b)].p_m)};
  }
  const std::span<const Pair> pairs{storage, n};
  const double tolerance = tolerance_m;
  UprightFit best;
  Motion kept;
  for (std::size_t i = 0; i < n && i < kPairedMatches; ++i) {
    for (std::size_t j = i + 1; j < n && j < kPairedMatches; ++j) {
      const Vec3 da = pairs[j].a - pairs[i].a, db = pairs[j].b - pairs[i].b;
      const double wide_a = std::sqrt(da.x * da.x + da.y * da.y),
                   wide_b = std::sqrt(db.x * db.x + db.y * db.y);
      if (wide_a < kLeastBase_m || std::fabs(wide_a - wide_b) > 2 * tolerance ||
          std::fabs(da.z - db.z) > 2 * tolerance)
        continue;
      Motion motion;
      const Pair* const two[2] = {&pairs[i], &pairs[j]};
      if (!fit(
              pairs, [&](const Pair& p) { return &p == two[0] || &p == two[1]; }, motion))
        continue;
      int inliers = 0;
      for (const Pair& p : pairs) inliers += norm(motion(p.a) - p.b) < tolerance ? 1 : 0;
      if (inliers > best.inliers) best.inliers = inliers, kept = motion;
    }
  }
  if (best.inliers < kLeastInliers) return {};
  Motion refined = kept;
  fit(
      pairs, [&](const Pair& p) { return norm(kept(p.a) - p.b) < tolerance; }, refined);
  best.inliers = 0;
  for (const Pair& p : pairs) best.inliers += norm(refined(p.a) - p.b) < tolerance ? 1 : 0;
  if (best.inliers < kLeastInliers) return {};
  best.found = true;
  best.T_b_a.R = {{refined.c, -refined.s, 0, refined.s, refined.c, 0, 0, 0, 1}};
  best.T_b_a.t = refined.t;
  return best;
}

}  // namespace st
