#include "algo/control/base_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "algo/control/symmetric3.hpp"
#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kLeastTravelM = 0.15;    // below that nothing can be said about how it drives
constexpr double kWidestSigmaRad = 0.35;  // a direction less certain than 20 degrees is none

struct Parameters {
  double phi = 0, c = 0, l = 0;
};

// The weights u with u.a = the motion that must vanish in the window.
void weights(const BaseWindow& window, const Parameters& p, double (&u)[3], double (&du_dphi)[3]) {
  const SinCos f = sin_cos(p.phi);
  if (window.on_the_spot) {
    u[0] = f.cos, u[1] = f.sin, u[2] = -p.l;
    du_dphi[0] = -f.sin, du_dphi[1] = f.cos;
  } else {
    u[0] = -f.sin, u[1] = f.cos, u[2] = p.c;
    du_dphi[0] = -f.cos, du_dphi[1] = -f.sin;
  }
  du_dphi[2] = 0;
}

double quadratic(const double (&C)[3][3], const double (&u)[3], const double (&v)[3]) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) sum += u[i] * C[i][k] * v[k];
  return sum;
}

double rms(const BaseWindow& window, const Parameters& p) {
  double C[3][3], u[3], du[3];
  scatter(window, C);
  weights(window, p, u, du);
  return std::sqrt(std::max(0.0, quadratic(C, u, u)) / static_cast<double>(window.n - 1));
}

struct Normal {
  Symmetric3 H;
  double g[3]{};
  double cost = 0;
};

void add_window(const BaseWindow& window, const Parameters& p, double variance, Normal& normal) {
  double C[3][3], u[3], du[3];
  scatter(window, C);
  weights(window, p, u, du);
  const double dl[3] = {0, 0, window.on_the_spot ? -1.0 : 0.0},
               dc[3] = {0, 0, window.on_the_spot ? 0.0 : 1.0};
  const double(*const J[3])[3] = {&du, &dc, &dl};
  const double weight = window.weight / variance;
  normal.cost += weight * quadratic(C, u, u);
  for (int r = 0; r < 3; ++r) {
    normal.g[r] += weight * quadratic(C, *J[r], u);
    for (int k = 0; k < 3; ++k) normal.H.m[r][k] += weight * quadratic(C, *J[r], *J[k]);
  }
}

void add_prior(const BasePrior& prior, const Parameters& p, Normal& normal) {
  const SinCos f = sin_cos(p.phi);
  const double forward = f.cos * prior.x_m + f.sin * prior.y_m, left = f.cos * prior.y_m - f.sin * prior.x_m;
  const double J[2][3] = {{-left, 1, 0}, {forward, 0, 1}};
  const double r[2] = {p.c - forward, p.l - left};
  const double sigma[2] = {prior.sigma_forward_m, prior.sigma_lateral_m};
  for (int i = 0; i < 2; ++i) {
    const double weight = 1.0 / (sigma[i] * sigma[i]);
    normal.H.add_outer(J[i], weight);
    normal.cost += weight * r[i] * r[i];
    for (int k = 0; k < 3; ++k) normal.g[k] += weight * J[i][k] * r[i];
  }
}

Normal build(std::span<const BaseWindow> windows, const BasePrior& prior, const Parameters& p,
             double variance) {
  Normal normal;
  for (const BaseWindow& window : windows) add_window(window, p, variance, normal);
  add_prior(prior, p, normal);
  return normal;
}

Parameters at_prior(const BasePrior& prior, double phi) {
  const SinCos f = sin_cos(phi);
  return {phi, f.cos * prior.x_m + f.sin * prior.y_m, f.cos * prior.y_m - f.sin * prior.x_m};
}

// Gauss-Newton with Levenberg's damping, a fixed number of steps.
Parameters refine(std::span<const BaseWindow> windows, const BasePrior& prior, Parameters p,
                  double variance) {
  constexpr int kSteps = 25;
  double damping = 1e-6;
  Normal normal = build(windows, prior, p, variance);
  for (int step = 0; step < kSteps; ++step) {
    Symmetric3 H = normal.H;
    for (int i = 0; i < 3; ++i) H.m[i][i] += damping * (H.m[i][i] + 1.0);
    const double downhill[3] = {-normal.g[0], -normal.g[1], -normal.g[2]};
    double d[3];
    if (!H.solve(downhill, d)) return p;
    const Parameters tried{p.phi + d[0], p.c + d[1], p.l + d[2]};
    const Normal there = build(windows, prior, tried, variance);
    if (there.cost <= normal.cost) {
      p = tried;
      normal = there;
      damping = std::max(1e-12, damping * 0.1);
    } else {
      damping = std::min(1e6, damping * 10.0);
    }
  }
  return p;
}

// The best of some starts round the half circle; driving backwards along an axis fits as well as forwards.
Parameters search(std::span<const BaseWindow> windows, const BasePrior& prior, double variance) {
  constexpr int kStarts = 18;
  Parameters best;
  double least = -1;
  for (int i = 0; i < kStarts; ++i) {
    const Parameters start = at_prior(prior, kPi * i / kStarts);
    const double cost = build(windows, prior, start, variance).cost;
    if (least < 0 || cost < least) least = cost, best = start;
  }
  return refine(windows, prior, best, variance);
}

// Cauchy weights: a window with a slip, a knock or a bad stretch of tracking counts less.
void reweigh(std::span<BaseWindow> windows, const Parameters& p, double variance) {
  for (BaseWindow& window : windows) {
    const double r = rms(window, p);
    constexpr double kTuning2 = 2.4 * 2.4;
    window.weight = 1.0 / (1.0 + r * r / (variance * kTuning2));
  }
}

double weighted_variance(std::span<const BaseWindow> windows, const Parameters& p) {
  double sum = 0, count = 0;
  for (const BaseWindow& window : windows) {
    const double r = rms(window, p), n = window.weight * static_cast<double>(window.n - 1);
    sum += n * r * r;
    count += n;
  }
  constexpr double kLeastSigmaM = 2e-4;
  return std::max(kLeastSigmaM * kLeastSigmaM, count > 0 ? sum / count : 0.0);
}

// How much the residuals' correlation in time takes from the number of independent samples.
double correlation_factor(std::span<const BaseWindow> windows, const Parameters& p) {
  double lag = 0, square = 0;
  for (const BaseWindow& window : windows) {
    double C[3][3], u[3], du[3];
    scatter(window, C);
    weights(window, p, u, du);
    lag += window.weight * lag_product(window, u);
    square += window.weight * quadratic(C, u, u);
  }
  const double rho = square > 0 ? std::clamp(lag / square, 0.0, 0.97) : 0.0;
  return (1 + rho) / (1 - rho);
}

Parameters fit(std::span<BaseWindow> windows, const BasePrior& prior, Parameters p) {
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    const double variance = weighted_variance(windows, p);
    reweigh(windows, p, variance);
    p = refine(windows, prior, p, weighted_variance(windows, p));
  }
  return p;
}

// How far the base itself travelled: windows in which its forward motion stands clear of what is unexplained
// across it.
double base_travel(std::span<const BaseWindow> windows, const Parameters& p) {
  constexpr double kClear = 3.0, kExtentOfRms = 3.46;  // sqrt(12), for even travel
  double sum = 0;
  for (BaseWindow window : windows) {
    if (window.on_the_spot) continue;
    const double across = rms(window, p);
    window.on_the_spot = true;  // the forward motion
    const double along = rms(window, p);
    if (along > kClear * across) sum += kExtentOfRms * along;
  }
  return sum;
}

// Whether nearly all of the motion was along the heading. A hand that pushes moves things sideways and turns
// them at will.
bool moved_like_one(std::span<const BaseWindow> windows, const Parameters& p, double jitter_m,
                    BaseEstimate& estimate) {
  constexpr double kFloorM = 0.006, kShare = 0.02, kLeastGood = 0.7;
  double good = 0, all = 0, square = 0, count = 0;
  for (const BaseWindow& window : windows) {
    if (window.on_the_spot) continue;
    const double r = rms(window, p);
    const double size = window.extent_m + 0.1 * window.turn_rad;  // a turn moves the robot's rim
    all += size;
    if (r <= std::max(kFloorM, 3 * jitter_m) + kShare * window.extent_m) good += size;
    square += r * r * static_cast<double>(window.n);
    count += static_cast<double>(window.n);
  }
  estimate.lateral_rms_m = count > 0 ? std::sqrt(square / count) : 0;
  return all > 0 && good >= kLeastGood * all;
}

// Inverse of the information, widened for correlated noise or, where it says more, for the scatter between
// windows.
Symmetric3 covariance(std::span<const BaseWindow> windows, const BasePrior& prior, const Parameters& p,
                      const Jitter& jitter) {
  const double variance = weighted_variance(windows, p) * correlation_factor(windows, p);
  Normal normal = build(windows, prior, p, variance);
  // Noise scatters travel and turning, which looks like information: take it out.
  double noise = 0;
  for (const BaseWindow& window : windows) noise += window.weight * point_noise(window) / variance;
  const auto reduce = [](double& information, double by) {
    information = std::max(0.02 * information, information - by);
  };
  reduce(normal.H.m[0][0], noise * jitter.position_m * jitter.position_m);
  reduce(normal.H.m[1][1], noise * jitter.yaw_rad * jitter.yaw_rad);
  Symmetric3 model, between, meat;
  if (!normal.H.invert(model)) return model;
  for (const BaseWindow& window : windows) {
    Normal one;
    add_window(window, p, variance, one);
    meat.add_outer(one.g, 1.0);
  }
  Normal shape;
  add_prior(prior, p, shape);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) meat.m[r][k] += shape.H.m[r][k];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) between.m[r][c] += model.m[r][i] * meat.m[i][k] * model.m[k][c];
  const double a = model.m[0][0] * 0.25 + model.m[1][1] + model.m[2][2];
  const double b = between.m[0][0] * 0.25 + between.m[1][1] + between.m[2][2];
  return b > a ? between : model;
}

void set_sigmas(const Symmetric3& cov, const Parameters& p, BaseEstimate& estimate) {
  // Position in axes along f and n: (c, l), moved by an error of phi as well.
  const double J[2][3] = {{-p.l, 1, 0}, {p.c, 0, 1}};
  double P[2][2]{};
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 2; ++c)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) P[r][c] += J[r][i] * cov.m[i][k] * J[c][k];
  const double mean = 0.5 * (P[0][0] + P[1][1]), half = 0.5 * (P[0][0] - P[1][1]);
  estimate.sigma_m = std::sqrt(std::max(0.0, mean + std::sqrt(half * half + P[0][1] * P[1][0])));
  estimate.sigma_rad = std::min(kPi, std::sqrt(std::max(0.0, cov.m[0][0])));
}

// Travel along the estimated direction, negative when it points backwards: the net travel, and where about as
// much was driven back as ahead, that of the beginning, since who drives there and back drives there first.
double net_forward(std::span<const BaseWindow> windows, const Parameters& p) {
  const SinCos f = sin_cos(p.phi);
  constexpr double kOneWay = 0.2, kBegun_m = 0.05;
  double sum = 0, all = 0, begun = 0;
  for (const BaseWindow& w : windows) {
    if (w.on_the_spot) continue;
    const double way =
        f.cos * (w.last[0] - w.first[0]) + f.sin * (w.last[1] - w.first[1]) - p.l * (w.last[2] - w.first[2]);
    if (begun == 0 && std::fabs(way) > kBegun_m) begun = way;
    sum += way;
    all += std::fabs(way);
  }
  return std::fabs(sum) > kOneWay * all ? sum : begun;
}

}  // namespace

BaseEstimate estimate_base(std::span<const PlanarSample> samples, const BasePrior& prior,
                           std::span<BaseWindow> windows) {
  BaseEstimate estimate;
  const std::size_t everywhere = fill_windows(samples, windows);
  if (everywhere == 0) return estimate;
  std::span<BaseWindow> used = windows.first(everywhere);
  for (const BaseWindow& w : used) estimate.turn_rad += w.turn_rad;

  constexpr double kFirstSigmaM = 0.005;
  Parameters p = search(used, prior, kFirstSigmaM * kFirstSigmaM);
  p = fit(used, prior, p);
  const SpotGate gate{p.phi, at_prior(prior, p.phi).l, std::clamp(3.0 * prior.sigma_lateral_m, 0.03, 0.10)};
  const std::size_t on_the_spot = fill_spot_windows(samples, gate, windows.subspan(everywhere));
  used = windows.first(everywhere + on_the_spot);
  for (const BaseWindow& w : used.subspan(everywhere)) estimate.spot_turn_rad += w.turn_rad;
  if (on_the_spot > 0) p = fit(used, prior, p);
  if (net_forward(used, p) < 0) p = {p.phi + kPi, -p.c, -p.l};

  const SinCos f = sin_cos(p.phi);
  estimate.x_m = p.c * f.cos - p.l * f.sin;
  estimate.y_m = p.c * f.sin + p.l * f.cos;
  estimate.yaw_rad = wrap_angle(p.phi);
  const Jitter jitter = jitter_of(samples);
  set_sigmas(covariance(used, prior, p, jitter), p, estimate);
  estimate.travel_m = base_travel(used, p);
  estimate.observed = estimate.travel_m >= kLeastTravelM && estimate.sigma_rad < kWidestSigmaRad;
  estimate.differential_drive = moved_like_one(used, p, jitter.position_m, estimate) && estimate.observed;
  return estimate;
}

}  // namespace st
