#include "algo/segmentation/floor.hpp"

#include <cmath>

#include "algo/segmentation/background.hpp"

namespace st {
namespace {

constexpr int kProposals = 400;
constexpr int kNeighbourhood =
    16;  // cells: three samples are drawn near each other, so that they share a surface
constexpr float kScoreTolerance = 18.0f;  // codes
constexpr int kRefineSteps = 6;
constexpr double kCosGravity = 0.98480775301220806;  // 10 degrees
constexpr double kSineSteepest =
    0.3420201433256687;  // up-component left when the camera looks down by 70 degrees
constexpr double kTangentRoll = 0.46630765815499858;  // 25 degrees
constexpr double kMinShare = 0.1;

// xorshift32 (Marsaglia 2003): the same planes are tried on every machine.
std::uint32_t next(std::uint32_t& state) {
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state;
}

int below(std::uint32_t& state, int bound) {
  return static_cast<int>(next(state) % static_cast<std::uint32_t>(bound));
}

// Solves the symmetric 3x3 system by Cramer's rule. False when it is singular.
bool solve3(const double m[6], const double r[3], double x[3]) {
  const double a = m[0], b = m[1], c = m[2], d = m[3], e = m[4], f = m[5];  // [a b c; b d e; c e f]
  const double A = d * f - e * e, B = c * e - b * f, C = b * e - c * d;
  const double det = a * A + b * B + c * C;
  if (!(std::fabs(det) > 1e-9)) return false;
  const double D = a * f - c * c, E = b * c - a * e, F = a * d - b * b;
  x[0] = (A * r[0] + B * r[1] + C * r[2]) / det;
  x[1] = (B * r[0] + D * r[1] + E * r[2]) / det;
  x[2] = (C * r[0] + E * r[1] + F * r[2]) / det;
  return true;
}

// Fills n and d. False for a plane through the camera's centre.
bool to_metric(const DepthTables& tables, const PlaneCodes& plane, Vec3& n, double& d) {
  const Intrinsics& camera = tables.calibration().depth;
  const double a = static_cast<double>(plane.a), b = static_cast<double>(plane.b);
  const double centre = static_cast<double>(plane.c) + tables.code_offset() + a * camera.cx + b * camera.cy;
  const double scale = -1.0 / tables.codes_per_inverse_m();
  const Vec3 n_over_d{a * camera.fx * scale, b * camera.fy * scale, centre * scale};
  const double length = norm(n_over_d);
  if (!(length > 1e-6)) return false;
  n = n_over_d * (1.0 / length);
  d = 1.0 / length;
  return true;
}

bool is_support(const Vec3& n, double d, bool has_up, const Vec3& up) {
  if (d < 0.1 || d > 6.0) return false;
  if (has_up) return dot(n, up) >= kCosGravity;
  return n.y <= -kSineSteepest && std::fabs(n.x) <= kTangentRoll * -n.y;
}

}  // namespace

void FloorFinder::bind(Bump& memory) {
  u_ = memory.take<float>(kSamples);
  v_ = memory.take<float>(kSamples);
  q_ = memory.take<float>(kSamples);
  packed_of_cell_ = memory.take<std::int16_t>(kSamples);
  cell_of_packed_ = memory.take<std::int16_t>(kSamples);
}

int FloorFinder::sample(ImageView<const std::uint16_t> background) {
  int known = 0;
  smallest_area_ = 16.0f * static_cast<float>(background.pixels()) / kSamples;
  for (int y = 0; y < kDown; ++y) {
    const int v = (2 * y + 1) * background.height / (2 * kDown);
    for (int x = 0; x < kAcross; ++x) {
      const int u = (2 * x + 1) * background.width / (2 * kAcross);
      const std::uint16_t code = background(u, v);
      const int cell = y * kAcross + x;
      packed_of_cell_[static_cast<std::size_t>(cell)] = -1;
      if (code == 0) continue;
      const auto at = static_cast<std::size_t>(known);
      u_[at] = static_cast<float>(u);
      v_[at] = static_cast<float>(v);
      q_[at] = static_cast<float>(code) * (1.0f / Background::kUnit);
      packed_of_cell_[static_cast<std::size_t>(cell)] = static_cast<std::int16_t>(known);
      cell_of_packed_[at] = static_cast<std::int16_t>(cell);
      ++known;
    }
  }
  return known;
}

bool FloorFinder::propose(std::uint32_t& random, PlaneCodes& plane) const {
  std::size_t at[3];
  at[0] = static_cast<std::size_t>(below(random, known_));
  const int cell = cell_of_packed_[at[0]];
  for (int i = 1; i < 3; ++i) {
    const int x = cell % kAcross + below(random, 2 * kNeighbourhood + 1) - kNeighbourhood;
    const int y = cell / kAcross + below(random, 2 * kNeighbourhood + 1) - kNeighbourhood;
    if (x < 0 || y < 0 || x >= kAcross || y >= kDown) return false;
    const int packed = packed_of_cell_[static_cast<std::size_t>(y * kAcross + x)];
    if (packed < 0) return false;
    at[i] = static_cast<std::size_t>(packed);
  }
  const float u1 = u_[at[1]] - u_[at[0]], v1 = v_[at[1]] - v_[at[0]], q1 = q_[at[1]] - q_[at[0]];
  const float u2 = u_[at[2]] - u_[at[0]], v2 = v_[at[2]] - v_[at[0]], q2 = q_[at[2]] - q_[at[0]];
  const float area = u1 * v2 - u2 * v1;
  if (!(std::fabs(area) > smallest_area_)) return false;  // slivers extrapolate badly
  plane.a = (q1 * v2 - q2 * v1) / area;
  plane.b = (u1 * q2 - u2 * q1) / area;
  plane.c = q_[at[0]] - plane.a * u_[at[0]] - plane.b * v_[at[0]];
  return true;
}

int FloorFinder::count_inliers(const PlaneCodes& plane, float tolerance) const {
  const float *u = u_.data(), *v = v_.data(), *q = q_.data();
  int count = 0;
  for (int i = 0; i < known_; ++i)
    count += std::fabs(plane.a * u[i] + plane.b * v[i] + plane.c - q[i]) < tolerance ? 1 : 0;
  return count;
}

// Tukey's biweight, its width narrowing from 40 to 14 codes: at first the proposal's extrapolation error is
// let in.
PlaneCodes FloorFinder::refine(PlaneCodes plane) const {
  for (int step = 0; step < kRefineSteps; ++step) {
    const double width = step < 2 ? 40.0 : step < 4 ? 24.0 : 14.0;
    double m[6]{}, r[3]{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(known_); ++i) {
      const double u = static_cast<double>(u_[i]) - 320.0, v = static_cast<double>(v_[i]) - 240.0;
      const double q = static_cast<double>(q_[i]);
      const double e = q - static_cast<double>(plane.a * u_[i] + plane.b * v_[i] + plane.c);
      const double t = 1.0 - e * e / (width * width);
      if (t <= 0) continue;
      const double w = t * t;
      m[0] += w * u * u, m[1] += w * u * v, m[2] += w * u, m[3] += w * v * v, m[4] += w * v, m[5] += w;
      r[0] += w * u * q, r[1] += w * v * q, r[2] += w * q;
    }
    double x[3];
    if (!solve3(m, r, x)) break;
    plane = {static_cast<float>(x[0]), static_cast<float>(x[1]),
             static_cast<float>(x[2] - x[0] * 320.0 - x[1] * 240.0)};
  }
  return plane;
}

// Over the samples within 14 codes, where a floor's own noise ends.
double FloorFinder::residual_sigma(const PlaneCodes& plane) const {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(known_); ++i) {
    const double e = static_cast<double>(q_[i] - (plane.a * u_[i] + plane.b * v_[i] + plane.c));
    if (std::fabs(e) > 14.0) continue;
    sum += e * e;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

Floor FloorFinder::find(const DepthTables& tables, ImageView<const std::uint16_t> background, bool has_up,
                        const Vec3& up) {
  Floor best;
  known_ = sample(background);
  if (known_ < kSamples / 50) return best;
  const Vec3 up_unit = normalized(up);
  std::uint32_t random = 0x9E3779B9u;
  int best_count = 0;
  PlaneCodes best_plane;
  for (int i = 0; i < kProposals; ++i) {
    PlaneCodes plane;
    Vec3 n;
    double d = 0;
    if (!propose(random, plane) || !to_metric(tables, plane, n, d)) continue;
    if (!is_support(n, d, has_up, up_unit)) continue;
    const int count = count_inliers(plane, kScoreTolerance);
    if (count > best_count) best_count = count, best_plane = plane;
  }
  if (best_count == 0) return best;
  best.codes = refine(best_plane);
  best.inlier_share = static_cast<double>(count_inliers(best.codes, kScoreTolerance)) / known_;
  best.sigma_code = residual_sigma(best.codes);
  best.found = best.inlier_share >= kMinShare && to_metric(tables, best.codes, best.n, best.d) &&
               is_support(best.n, best.d, has_up, up_unit);
  return best;
}

}  // namespace st
