#include "algo/control/path_compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "algo/control/symmetric3.hpp"
#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kMovedM = 0.02, kMovedRad = 0.08;  // more than noise: it has moved

double squared(double v) { return v * v; }

bool away(const PlanarSample& sample, const Pose2& from) {
  return squared(sample.x_m - from.x) + squared(sample.y_m - from.y) > kMovedM * kMovedM ||
         std::fabs(wrap_angle(sample.yaw_rad - from.yaw)) > kMovedRad;
}

// The first sample from which on it is away; one or two outliers are not enough. size() when it never is.
std::size_t first_away(std::span<const PlanarSample> samples, const Pose2& from) {
  constexpr std::size_t kInARow = 3;
  std::size_t row = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    row = away(samples[i], from) ? row + 1 : 0;
    if (row == kInARow) return i + 1 - kInARow;
  }
  return samples.size();
}

// A place on the path, `at` along one of its segments.
struct Place {
  double at = 0;
  PathSample sample;
  bool whole_offset =
      false;  // at an open end or in a turn on the spot: every distance counts, not only sideways
};

PathSample between(const PathSample& a, const PathSample& b, double at) {
  const auto mix = [at](double p, double q) { return p + at * (q - p); };
  return {mix(a.t_s, b.t_s),         mix(a.x_m, b.x_m),     mix(a.y_m, b.y_m),
          mix(a.yaw_rad, b.yaw_rad), mix(a.v_mps, b.v_mps), mix(a.w_rps, b.w_rps)};
}

// Follows a base along a path. Nearness is in place and heading, so that a turn on the spot has its course as
// well.
class PathFollower {
 public:
  explicit PathFollower(std::span<const PathSample> path)
      : path_(path),
        segments_(static_cast<std::ptrdiff_t>(path.size()) - 1),
        closed_(ends_where_it_starts(path)) {}

  // `p` in the path's frame, `dt_s` after the one before.
  Place next(const Pose2& p, double dt_s) {
    // The window is measured in length, so that a wait in the path does not hold the follower.
    const std::ptrdiff_t here = k_;
    std::ptrdiff_t k = here;
    for (double back = 0; on_path(k - 1) && here - k < segments_ && back <= kBackM; --k)
      back += length(k - 1);
    const double room = kAheadM + kFastestMps * dt_s;
    double best = -1, ahead = 0;
    Place place;
    for (; on_path(k) && k - here < segments_ && ahead <= room; ++k) {
      if (k > here) ahead += length(k);
      const double at = nearest(from(k), to(k), p);
      const PathSample there = between(from(k), to(k), at);
      const double cost = squared(p.x - there.x_m) + squared(p.y - there.y_m) +
                          squared(kLeverM * wrap_angle(p.yaw - there.yaw_rad));
      if (best >= 0 && cost >= best) continue;
      best = cost;
      k_ = k;
      place = {at, there, false};
    }
    const bool stands =
        squared(to(k_).x_m - from(k_).x_m) + squared(to(k_).y_m - from(k_).y_m) < squared(kStandingM);
    const bool at_start = !closed_ && k_ == 0 && place.at <= 0;
    const bool at_end = !closed_ && k_ + 1 == segments_ && place.at >= 1;
    place.whole_offset = stands || at_start || at_end;
    place.sample.t_s += static_cast<double>(lap(k_)) * (path_.back().t_s - path_.front().t_s);
    return place;
  }

 private:
  // How far a sample may lie from the one before.
  static constexpr double kBackM = 0.1, kAheadM = 0.12, kFastestMps = 1.0;
  static constexpr double kLeverM = 0.15;  // a radian weighs as much as this distance
  static constexpr double kStandingM = 1e-6;

  // A closed path goes on where it starts: who drives a little too far round a circle is not beside it.
  static bool ends_where_it_starts(std::span<const PathSample> path) {
    constexpr double kNearM = 0.02, kNearRad = 0.1, kLeastTurnRad = 3.0;
    double turned = 0;
    for (std::size_t i = 1; i < path.size(); ++i) turned += std::fabs(path[i].yaw_rad - path[i - 1].yaw_rad);
    const PathSample &a = path.front(), &b = path.back();
    return turned > kLeastTurnRad && squared(b.x_m - a.x_m) + squared(b.y_m - a.y_m) < kNearM * kNearM &&
           std::fabs(wrap_angle(b.yaw_rad - a.yaw_rad)) < kNearRad;
  }

  // Segments are counted through all laps, from 0; those of an open path end.
  bool on_path(std::ptrdiff_t k) const { return closed_ || (k >= 0 && k < segments_); }
  std::ptrdiff_t lap(std::ptrdiff_t k) const { return (k >= 0 ? k : k - segments_ + 1) / segments_; }
  const PathSample& from(std::ptrdiff_t k) const {
    return path_[static_cast<std::size_t>(k - lap(k) * segments_)];
  }
  const PathSample& to(std::ptrdiff_t k) const {
    return path_[static_cast<std::size_t>(k - lap(k) * segments_ + 1)];
  }
  double length(std::ptrdiff_t k) const {
    const PathSample &a = from(k), &b = to(k);
    return std::sqrt(squared(b.x_m - a.x_m) + squared(b.y_m - a.y_m)) +
           kLeverM * std::fabs(b.yaw_rad - a.yaw_rad);
  }
  static double nearest(const PathSample& a, const PathSample& b, const Pose2& p) {
    const double dx = b.x_m - a.x_m, dy = b.y_m - a.y_m, turn = kLeverM * (b.yaw_rad - a.yaw_rad);
    const double length2 = dx * dx + dy * dy + turn * turn;
    if (length2 <= 0) return 0;
    const double along =
        (p.x - a.x_m) * dx + (p.y - a.y_m) * dy + kLeverM * wrap_angle(p.yaw - a.yaw_rad) * turn;
    return std::clamp(along / length2, 0.0, 1.0);
  }

  std::span<const PathSample> path_;
  std::ptrdiff_t segments_;
  bool closed_;
  std::ptrdiff_t k_ = 0;
};

Pose2 in_path(const PlanarSample& sample, const Pose2& T_path_floor) {
  return compose(T_path_floor, {sample.x_m, sample.y_m, sample.yaw_rad});
}

// One step towards the placement with the least squared distances. Where the path leaves it open (round a
// circle's middle) it stays.
Pose2 improved(std::span<const PathSample> path, std::span<const PlanarSample> base, std::size_t stride,
               const Pose2& T_floor_path) {
  const Pose2 T_path_floor = inverse(T_floor_path);
  PathFollower follower(path);
  Symmetric3 H;
  double g[3] = {0, 0, 0};
  double last_t_s = base.front().t_s;
  for (std::size_t i = 0; i < base.size(); i += stride) {
    const Pose2 p = in_path(base[i], T_path_floor);
    const Place place = follower.next(p, base[i].t_s - last_t_s);
    last_t_s = base[i].t_s;
    const SinCos h = sin_cos(place.sample.yaw_rad);
    const double ex = p.x - place.sample.x_m, ey = p.y - place.sample.y_m;
    const double directions[2][2] = {{-h.sin, h.cos}, {h.cos, h.sin}};
    for (int d = 0; d < (place.whole_offset ? 2 : 1); ++d) {
      const double nx = directions[d][0], ny = directions[d][1];
      const double row[3] = {nx, ny, p.x * ny - p.y * nx}, r = nx * ex + ny * ey;
      H.add_outer(row, 1.0);
      for (int k = 0; k < 3; ++k) g[k] += row[k] * r;
    }
  }
  constexpr double kHold = 1e-4;
  const std::size_t rows = base.size() / stride + 1;
  const double hold = kHold * static_cast<double>(rows);
  for (int k = 0; k < 3; ++k) H.m[k][k] += hold;
  double step[3];
  if (!H.solve(g, step)) return T_floor_path;
  return compose(T_floor_path, {step[0], step[1], step[2]});
}

PathMeasure measure(std::span<const PathSample> path, std::span<const PlanarSample> base,
                    const Pose2& T_floor_path, std::span<PathError> errors) {
  PathMeasure result;
  result.T_floor_path = T_floor_path;
  const Pose2 T_path_floor = inverse(T_floor_path);
  PathFollower follower(path);
  double square = 0, heading_square = 0;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const Pose2 p = in_path(base[i], T_path_floor);
    const Place place = follower.next(p, i == 0 ? 0.0 : base[i].t_s - base[i - 1].t_s);
    const SinCos h = sin_cos(place.sample.yaw_rad);
    const double ex = p.x - place.sample.x_m, ey = p.y - place.sample.y_m;
    const double left = h.cos * ey - h.sin * ex;
    const double distance = place.whole_offset ? std::sqrt(ex * ex + ey * ey) : std::fabs(left);
    const double heading = wrap_angle(p.yaw - place.sample.yaw_rad);
    errors[i] = {base[i].t_s, place.sample.t_s, left < 0 ? -distance : distance, heading};
    square += distance * distance;
    heading_square += heading * heading;
    result.max_m = std::max(result.max_m, distance);
    inside += distance <= kPathBandM ? 1 : 0;
  }
  const double n = static_cast<double>(base.size());
  result.rmse_m = std::sqrt(square / n);
  result.heading_rmse_rad = std::sqrt(heading_square / n);
  result.in_band = static_cast<double>(inside) / n;
  return result;
}

// From the start of motion to its end. What happens long after the path should be over is another story.
void find_motion(std::span<const PathSample> path, std::span<const PlanarSample> base,
                 PathComparison& result) {
  const Pose2 start = first_pose(base);
  const std::size_t first = first_away(base, start);
  if (first == base.size()) return;
  constexpr double kLateShare = 1.5, kLateS = 3.0;
  const double latest_s = base[first].t_s + kLateShare * (path.back().t_s - path.front().t_s) + kLateS;
  std::size_t end = base.size();
  while (end > first + 1 && base[end - 1].t_s > latest_s) --end;
  const Pose2 stop{base[end - 1].x_m, base[end - 1].y_m, base[end - 1].yaw_rad};
  std::size_t still = 0;  // how many of the last samples stay where it stopped
  while (end - still > first + 1 &&
         (!away(base[end - still - 1], stop) || !away(base[end - still - 2], stop)))
    ++still;
  constexpr double kApproachS = 0.5;  // the last centimetres up to the stop are part of the motion
  const double until_s = base[end - still - 1].t_s + kApproachS;
  while (still > 0 && base[end - still].t_s <= until_s) --still;
  end -= still;
  // The samples just before count too: the first centimetre belongs to the motion.
  result.first = first > 0 ? first - 1 : 0;
  result.count = end - result.first;
}

void fit_circles(std::span<const PathSample> path, std::span<const PlanarSample> base,
                 std::span<Point2> scratch, PathComparison& result) {
  constexpr double kRound = 0.01, kLeastTurnRad = 3.1;
  std::size_t n = 0;
  const std::size_t stride = path.size() / scratch.size() + 1;
  for (std::size_t i = 0; i < path.size(); i += stride) {
    const Pose2 p = compose(result.as_placed.T_floor_path, {path[i].x_m, path[i].y_m, 0});
    scratch[n++] = {p.x, p.y};
  }
  result.preset_circle = fit_circle(scratch.first(n));
  const double turn = std::fabs(path.back().yaw_rad - path.front().yaw_rad);
  if (!result.preset_circle.valid || result.preset_circle.rms_m > kRound * result.preset_circle.radius_m ||
      turn < kLeastTurnRad)
    return;
  for (std::size_t i = 0; i < base.size(); ++i) scratch[i] = {base[i].x_m, base[i].y_m};
  result.driven_circle = fit_circle(scratch.first(base.size()));
  result.is_circle = result.driven_circle.valid;
}

}  // namespace

Pose2 first_pose(std::span<const PlanarSample> base) {
  constexpr double kLongestS = 3.0, kStandingS = 0.4, kLineS = 0.34;
  const PlanarSample& origin = base.front();
  const Pose2 reference{origin.x_m, origin.y_m, origin.yaw_rad};
  std::size_t standing = first_away(base, reference);
  while (standing > 1 && base[standing - 1].t_s - origin.t_s > kLongestS) --standing;
  standing = std::max<std::size_t>(standing, 1);
  const double stood_s = base[standing - 1].t_s - origin.t_s;
  const bool stands = stood_s >= kStandingS;
  // The later half may hold the first millimetres of a slow start.
  const double used_s = stands ? 0.5 * stood_s : kLineS;
  // Lines a + b t through x, y and yaw; b is held at zero while it stands.
  double n = 0, st = 0, stt = 0, sx[3] = {0, 0, 0}, stx[3] = {0, 0, 0};
  for (const PlanarSample& sample : base) {
    const double t = sample.t_s - origin.t_s;
    if (t > used_s) break;
    const double x[3] = {sample.x_m - origin.x_m, sample.y_m - origin.y_m,
                         wrap_angle(sample.yaw_rad - origin.yaw_rad)};
    n += 1, st += t, stt += t * t;
    for (int i = 0; i < 3; ++i) sx[i] += x[i], stx[i] += t * x[i];
  }
  const double det = n * stt - st * st;
  double a[3];
  for (int i = 0; i < 3; ++i) a[i] = stands || !(det > 0) ? sx[i] / n : (stt * sx[i] - st * stx[i]) / det;
  return {origin.x_m + a[0], origin.y_m + a[1], wrap_angle(origin.yaw_rad + a[2])};
}

PathComparison compare_path(std::span<const PathSample> path, std::span<const PlanarSample> base,
                            std::span<PathError> placed, std::span<PathError> shaped,
                            std::span<Point2> scratch) {
  PathComparison result;
  if (path.size() < 2 || base.empty()) return result;
  find_motion(path, base, result);
  if (result.count < 2) return result;
  const std::span<const PlanarSample> moving = base.subspan(result.first, result.count);
  const Pose2 T_path_start = inverse({path.front().x_m, path.front().y_m, path.front().yaw_rad});
  const Pose2 as_placed = compose(first_pose(base), T_path_start);
  result.as_placed = measure(path, moving, as_placed, placed);

  constexpr int kSteps = 30;
  constexpr std::size_t kFitSamples = 2000;
  Pose2 fitted = as_placed;
  for (int step = 0; step < kSteps; ++step)
    fitted = improved(path, moving, moving.size() / kFitSamples + 1, fitted);
  result.shape = measure(path, moving, fitted, shaped);
  // The fit follows the nearest place; should that lead astray, the path as placed is the better shape.
  if (result.shape.rmse_m > result.as_placed.rmse_m) result.shape = measure(path, moving, as_placed, shaped);
  fit_circles(path, moving, scratch, result);
  result.valid = true;
  return result;
}

}  // namespace st
