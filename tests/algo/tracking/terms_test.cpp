// Every term's Jacobian against differences of its own residual, and what each term sees and does not see.
#include <cmath>
#include <functional>
#include <memory>

#include <CppUTest/TestHarness.h>

#include "algo/tracking/color_term.hpp"
#include "algo/tracking/contour_term.hpp"
#include "algo/tracking/depth_term.hpp"
#include "tests/algo/tracking/flat_view.hpp"
#include "tests/algo/tracking/seen_colors.hpp"
#include "tests/support/bound.hpp"

using namespace st;
using namespace st::test;

namespace {

constexpr int kN = NormalEquations::kSize;
const Vec3 kPivot{0.05, -0.02, 1.1};

// The unknowns: motion about the pivot, then the colour image's shift in pixels.
struct Unknowns {
  double x[kN]{};
  Pose motion() const { return moved_about(Pose{}, {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}}, kPivot); }
};
using Residual = std::function<double(const Unknowns&)>;

// One residual, however often it was added: H = W J J^T, g = W J r with one weight W. J by differences.
void check_jacobian(const NormalEquations& eq, const Residual& residual, int unknowns) {
  const double r = residual({});
  double J[kN]{};
  int steepest = 0;
  for (int i = 0; i < unknowns; ++i) {
    constexpr double h = 1e-5;
    Unknowns ahead, back;
    ahead.x[i] = h;
    back.x[i] = -h;
    J[i] = (residual(ahead) - residual(back)) / (2 * h);
    if (std::fabs(J[i]) > std::fabs(J[steepest])) steepest = i;
  }
  const double most = std::fabs(J[steepest]);
  const double W = eq.H[steepest * kN + steepest] / (most * most);
  CHECK(W > 0);
  for (int i = 0; i < unknowns; ++i) {
    DOUBLES_EQUAL(J[i] / most, eq.g[i] / (W * r * most), 5e-3);
    for (int j = i; j < unknowns; ++j)
      DOUBLES_EQUAL(J[i] / most * J[j] / most, eq.H[i * kN + j] / (W * most * most), 5e-3);
  }
}

Vec3f on_pixel(float u, float v, float z) { return kSmallCamera.ray(u, v) * z; }

}  // namespace

TEST_GROUP(TrackingTerms) {
  ViewTable view;
  PointTable points;
  BoundMemory memory{[this](Bump& bump) {
    view.bind(bump, 160, 120);
    points.bind(bump);
  }};
};

TEST(TrackingTerms, DepthJacobian) {
  const Vec3f n = normalized(Vec3f{0.3f, -0.4f, -0.8f});
  const float offset = dot(n, Vec3f{0, 0, 1.2f});
  const FlatView flat({60, 40, 110, 90}, n, offset);
  build_view_table(flat.view, view);
  const Vec3f p = on_pixel(90, 70, flat.view.z(90, 70)) + n * 0.006f;
  arrange_points(std::vector<ObservedPoint>(3, {p, 90, 70}), PointTable::kMost, points);
  NormalEquations eq;
  const DepthTermResult result =
      add_depth_term(points, points.count, view, kSmallCamera, Pose{}, kPivot, {}, eq);
  LONGS_EQUAL(3, result.paired);
  DOUBLES_EQUAL(0.006, result.rms_m, 1e-4);
  check_jacobian(
      eq,
      [&](const Unknowns& x) {
        return dot(to_double(n), x.motion().inverse() * to_double(p)) - static_cast<double>(offset);
      },
      6);
}

TEST(TrackingTerms, DepthRefusesWhatIsTooFarAway) {
  const FlatView flat({60, 40, 110, 90}, {0, 0, -1}, -1.2f);
  build_view_table(flat.view, view);
  std::vector<ObservedPoint> seen;
  for (const float gap : {0.0f, 0.004f, 0.2f, -0.2f}) seen.push_back({on_pixel(80, 60, 1.2f - gap), 80, 60});
  seen.push_back({on_pixel(10, 10, 1.2f), 10, 10});  // beside the view
  arrange_points(seen, PointTable::kMost, points);
  DepthTermOptions options;
  options.gate_m = 0.03f;
  NormalEquations eq;
  const DepthTermResult result =
      add_depth_term(points, points.count, view, kSmallCamera, Pose{}, kPivot, options, eq);
  LONGS_EQUAL(5, result.tried);
  LONGS_EQUAL(2, result.paired);
  LONGS_EQUAL(2, result.inliers);
  DOUBLES_EQUAL(0.004 / std::sqrt(2.0), result.rms_m, 1e-5);
}

TEST(TrackingTerms, ColourJacobianAndItsShift) {
  const auto image = [](double u, double v) { return 10 + 2 * (u - 40) + (v - 20); };
  Calibration calibration;
  calibration.depth = calibration.color = intrinsics_of(kSmallCamera);
  calibration.color.fx = 130;  // a camera of its own, beside
  calibration.T_color_depth = {rotation_from_vector({0.02, -0.03, 0.05}), {-0.02, 0.01, 0.005}};
  const SeenColors colors(calibration, kSmallCamera,
                          [&](int u, int v) { return std::fmin(255, std::fmax(0, image(u, v))); });
  const Pose then{rotation_from_vector({0.1, 0.05, -0.2}), {0.01, 0.02, 0.03}};
  const ColorGain gain{1.25f, 4.0f};
  const Vec3 p = to_double(on_pixel(85.3f, 65.2f, 1.2f));
  const auto seen = [&](const Pose& at, double du, double dv) {
    const Vec3 q = calibration.T_color_depth * (at * p);
    const Intrinsics& k = calibration.color;
    return image(k.fx * q.x / q.z + k.cx + du, k.fy * q.y / q.z + k.cy + dv);
  };
  const double model = (seen(then, 0, 0) - gain.offset - 3) / gain.gain;
  // Many times the same, since the term measures the scale of its residuals.
  points.begin(64, PointTable::kMost);
  for (std::size_t k = 0; k < 64; ++k) points.put(k, to_float(p), static_cast<float>(model));
  NormalEquations eq;
  const ColorTermResult result =
      add_color_term({points, points.count, colors.frame, then}, kPivot, gain, {0, 0}, {}, eq);
  LONGS_EQUAL(64, result.used);
  check_jacobian(
      eq,
      [&](const Unknowns& x) {
        return seen(x.motion() * then, x.x[6], x.x[7]) - gain.gain * model - gain.offset;
      },
      kN);
}

TEST_GROUP(TrackingContour) {
  // A square plate 1 m away before a wall at 2 m. In the frame it stands `shift_px` to the right of the view,
  // and something near hides its first columns.
  std::vector<float> depth;
  ImageView<const float> frame(int shift_px, int hidden_columns) {
    depth.assign(160 * 120, 2.0f);
    for (int v = 45; v < 75; ++v)
      for (int u = 65 + shift_px; u < 95 + shift_px; ++u)
        depth[static_cast<std::size_t>(v * 160 + u)] = u < 65 + shift_px + hidden_columns ? 0.7f : 1.0f;
    return {depth.data(), 160, 120};
  }
  FlatView plate{{65, 45, 95, 75}, {0, 0, -1}, -1.0f};
  ViewTable view;
  BoundMemory memory{[this](Bump& bump) { view.bind(bump, 160, 120); }};
  OutlinePoint outline[kMaxContourPoints];
  ContourPoint contour[kMaxContourPoints];

  std::span<const ContourPoint> edges(int shift_px, int hidden_columns = 0) {
    build_view_table(plate.view, view);
    const std::size_t n = find_outline(view, kSmallCamera, outline);
    return {contour,
            find_contour({outline, n}, kSmallCamera, frame(shift_px, hidden_columns), Pose{}, {}, contour)};
  }
};

TEST(TrackingContour, OneSolveFindsTheSidewaysShiftAndNoTurn) {
  NormalEquations eq;
  CHECK(add_contour_term(edges(3), kSmallCamera, Pose{}, {}, eq) > 40);
  DOUBLES_EQUAL(3.0 / 144, -eq.g[0] / eq.H[0], 0.004);  // 3 pixels at 1 m
  DOUBLES_EQUAL(0, eq.g[1] / eq.H[kN + 1], 0.002);
  for (int axis = 3; axis < 6; ++axis) DOUBLES_EQUAL(0, eq.H[axis * kN + axis], 0);
}

TEST(TrackingContour, JacobianOfOneEdge) {
  // Three edges that look the same way, so that the outline's common offset is that of the two others.
  const ContourPoint at_rest{{{0.1f, 0.05f, 1.0f}, 0.6f, 0.8f}, 144 * (0.6f * 0.1f + 0.8f * 0.05f), 1};
  ContourPoint moved = at_rest;
  moved.edge_px += 1.5f;
  const ContourPoint some[] = {at_rest, at_rest, moved};
  NormalEquations eq, still;
  add_contour_term(some, kSmallCamera, Pose{}, {}, eq);
  add_contour_term({some, 2}, kSmallCamera, Pose{}, {}, still);
  for (int i = 0; i < kN * kN; ++i) eq.H[i] -= still.H[i];
  for (int i = 0; i < kN; ++i) eq.g[i] -= still.g[i];
  check_jacobian(
      eq,
      [&](const Unknowns& x) {
        const Vec3 p = x.motion() * to_double(moved.outline.p);
        return static_cast<double>(moved.edge_px) - 144 * (0.6 * p.x + 0.8 * p.y) / p.z;
      },
      3);
}

TEST(TrackingContour, WhatSomethingInFrontHidesIsNoEdge) {
  const std::size_t whole = edges(0).size();
  const std::span<const ContourPoint> covered = edges(0, 10);
  CHECK(covered.size() + 25 < whole);
  for (const ContourPoint& edge : covered) CHECK(edge.outline.nu > -0.9f);
}
