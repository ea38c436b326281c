#include "algo/tracking/contour_term.hpp"

#include <cmath>

namespace st {
namespace {

// Outward normal of the view's surface at (u, v): away from the filled pixels of a 5x5 window. False inside
// of it.
bool outline_normal(const ViewTable& view, int u, int v, float& nu, float& nv) {
  if (view.at(u - 1, v).z > 0 && view.at(u + 1, v).z > 0 && view.at(u, v - 1).z > 0 &&
      view.at(u, v + 1).z > 0)
    return false;
  int su = 0, sv = 0;
  for (int dv = -2; dv <= 2; ++dv)
    for (int du = -2; du <= 2; ++du)
      if (!(view.at(u + du, v + dv).z > 0)) su += du, sv += dv;
  const float length = std::sqrt(static_cast<float>(su * su + sv * sv));
  if (length < 6.0f) return false;  // a pinhole or a thread, not an outline
  nu = static_cast<float>(su) / length;
  nv = static_cast<float>(sv) / length;
  return true;
}

enum class Side { kInside, kOutside, kUnknown };

// Walks along the normal from -reach to +reach and finds the step from inside to outside nearest to the
// start.
bool find_step(ImageView<const float> depth_z, float fu, float fv, float model_z, const ContourTermOptions& o,
               ContourPoint& point) {
  int last_inside = -1000, best = -1000, best_gap = 0;
  bool found = false;
  for (int s = -o.reach_px; s <= o.reach_px; ++s) {
    const int u = static_cast<int>(std::floor(fu + static_cast<float>(s) * point.outline.nu + 0.5f));
    const int v = static_cast<int>(std::floor(fv + static_cast<float>(s) * point.outline.nv + 0.5f));
    if (!depth_z.contains(u, v)) break;
    const float z = depth_z(u, v);
    Side side = Side::kUnknown;
    if (z > 0 && std::fabs(z - model_z) < o.inside_gate_m) side = Side::kInside;
    if (z >= model_z + o.behind_m && side != Side::kInside) side = Side::kOutside;
    if (z > 0 && z < model_z - o.inside_gate_m)
      last_inside = -1000;  // something in front: what it hides is not an edge
    if (side == Side::kInside) last_inside = s;
    if (side == Side::kOutside && last_inside > -1000) {
      const int middle2 = s + last_inside;  // twice the middle
      if (!found || std::abs(middle2) < std::abs(best))
        best = middle2, best_gap = s - last_inside, found = true;
      last_inside = -1000;
    }
  }
  if (!found || best_gap > 8) return false;
  point.edge_px = 0.5f * static_cast<float>(best);
  point.sigma_px = 0.8f + 0.35f * static_cast<float>(best_gap - 1);
  return true;
}

// Median by counting in bins of a 128th of the range: bounded, no sorting of a copy.
float median(std::span<const float> residuals, float range_px) {
  constexpr int kBins = 257;
  int bins[kBins]{};
  int total = 0;
  const float per_bin = 128.0f / range_px;
  for (const float r : residuals) {
    if (!(std::fabs(r) < range_px)) continue;
    ++bins[static_cast<int>(r * per_bin + 128.5f)];
    ++total;
  }
  int below = 0;
  for (int i = 0; i < kBins; ++i) {
    below += bins[i];
    if (2 * below >= total) return static_cast<float>(i - 128) / per_bin;
  }
  return 0;
}

}  // namespace

std::size_t find_outline(const ViewTable& view, const Pinhole& camera, std::span<OutlinePoint> out) {
  const Rect& box = view.roi;
  std::size_t used = 0, every = 1, seen = 0;
  for (int v = box.v0; v < box.v1; ++v) {
    for (int u = box.u0; u < box.u1; ++u) {
      const float z = view.at(u, v).z;
      OutlinePoint point;
      if (!(z > 0) || !outline_normal(view, u, v, point.nu, point.nv)) continue;
      if (seen++ % every != 0) continue;
      if (used == out.size()) {  // keep every other one, and from now on half as many
        for (std::size_t i = 0; 2 * i < used; ++i) out[i] = out[2 * i];
        used = (used + 1) / 2;
        every *= 2;
        if ((seen - 1) % every != 0) continue;
      }
      point.p = camera.ray(static_cast<float>(u), static_cast<float>(v)) * z;
      out[used++] = point;
    }
  }
  return used;
}

std::size_t find_contour(std::span<const OutlinePoint> outline, const Pinhole& camera,
                         ImageView<const float> depth_z, const Pose& D, const ContourTermOptions& options,
                         std::span<ContourPoint> out) {
  const PoseF Df = to_float(D);
  std::size_t used = 0;
  for (const OutlinePoint& point : outline) {
    const Vec3f now = Df * point.p;
    if (!(now.z > 0.1f)) continue;
    const float u = camera.fx * now.x / now.z, v = camera.fy * now.y / now.z;
    ContourPoint edge;
    edge.outline = point;
    if (!find_step(depth_z, u + camera.cx, v + camera.cy, now.z, options, edge)) continue;
    edge.edge_px += point.nu * u + point.nv * v;
    out[used++] = edge;
  }
  return used;
}

int add_contour_term(std::span<const ContourPoint> contour, const Pinhole& camera, const Pose& D,
                     const ContourTermOptions& options, NormalEquations& into) {
  const PoseF Df = to_float(D);
  const std::size_t count = contour.size() < kMaxContourPoints ? contour.size() : kMaxContourPoints;
  Vec3f moved[kMaxContourPoints];
  float residual[kMaxContourPoints];
  for (std::size_t i = 0; i < count; ++i) {
    const OutlinePoint& point = contour[i].outline;
    const Vec3f x = Df * point.p;
    const float iz = 1.0f / x.z;
    // Kept as (fx x / z, fy y / z, 1 / z): all that follows needs.
    moved[i] = {camera.fx * x.x * iz, camera.fy * x.y * iz, iz};
    residual[i] = contour[i].edge_px - (point.nu * moved[i].x + point.nv * moved[i].y);
  }
  const float common = median({residual, count}, 2.0f * static_cast<float>(options.reach_px));
  const float per_robust2 = 1.0f / (options.robust_px * options.robust_px);
  double triangle[6]{}, gradient[3]{};
  int used = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const OutlinePoint& point = contour[i].outline;
    const float r = residual[i] - common;
    const float x2 = r * r * per_robust2;
    if (x2 >= 1.0f) continue;
    const float sigma2 = contour[i].sigma_px * contour[i].sigma_px;
    const double w = (1.0f - x2) * (1.0f - x2) / (sigma2 * options.correlated_pixels);
    // -d(n . projection)/dx; x moves with the object.
    const double N[3] = {-point.nu * camera.fx * moved[i].z, -point.nv * camera.fy * moved[i].z,
                         (point.nu * moved[i].x + point.nv * moved[i].y) * moved[i].z};
    int k = 0;
    for (int a = 0; a < 3; ++a) {
      gradient[a] += w * N[a] * r;
      for (int b = a; b < 3; ++b) triangle[k++] += w * N[a] * N[b];
    }
    ++used;
  }
  into.add_sums(triangle, gradient, 3);
  return used;
}

}  // namespace st
