#include "algo/tracking/align.hpp"

#include <CppUTest/TestHarness.h>

#include "algo/core/simd.hpp"
#include "tests/algo/tracking/flat_view.hpp"
#include "tests/algo/tracking/painted_ellipsoid.hpp"
#include "tests/algo/tracking/seen_colors.hpp"
#include "tests/support/bound.hpp"

using namespace st;
using namespace st::test;

namespace {

const Pose kAt{rotation_from_vector({0.3, 0.5, -0.2}), {0.05, -0.03, 1.3}};

struct Work {
  AlignScratch scratch;
  BoundMemory memory{[this](Bump& b) { scratch.bind(b, 320, 240); }};
};

// The depth term of every point, in plain doubles.
NormalEquations plain_depth_term(const PaintedFrame& frame, const ModelView& view, const Pinhole& camera,
                                 const Pose& D, const Vec3& pivot, const DepthTermOptions& o) {
  NormalEquations eq;
  const Pose to_view = D.inverse();
  for (const ObservedPoint& point : frame.points) {
    const Vec3 p = to_double(point.p), q = to_view * p;
    const int u = static_cast<int>(std::floor(camera.fx * q.x / q.z + camera.cx + 0.5));
    const int v = static_cast<int>(std::floor(camera.fy * q.y / q.z + camera.cy + 0.5));
    const double z = view.z(u, v);
    if (!(z > 0)) continue;
    const Vec3 ray{(u - double{camera.cx}) / camera.fx, (v - double{camera.cy}) / camera.fy, 1},
        gap = q - ray * z;
    const double sigma = depth_sigma_m(static_cast<float>(q.z));
    if (dot(gap, gap) > o.gate_m * o.gate_m + 16 * sigma * sigma) continue;
    const Vec3 n = to_double(unpack_normal(view.maps.normal[view.maps.at(u, v)]));
    const double r = dot(n, gap), lateral = 0.5 * q.z / camera.fx;
    const double variance = sigma * n.z * sigma * n.z + lateral * lateral;
    const double x2 = r * r / (variance * o.robust_sigmas * o.robust_sigmas);
    if (x2 >= 1) continue;
    const Vec3 N = D.R * n, m = cross(p - pivot, N);
    const double J[6] = {-N.x, -N.y, -N.z, -m.x, -m.y, -m.z};
    eq.add(J, r, (1 - x2) * (1 - x2) / (variance * o.correlated_pixels));
  }
  return eq;
}

double largest(const NormalEquations& eq) {
  double most = 0;
  for (const double h : eq.H) most = std::fabs(h) > most ? std::fabs(h) : most;
  return most;
}

}  // namespace

TEST_GROUP(Align) {
  PaintedEllipsoid thing;
  Work work;

  void teardown() override { select_simd(nullptr); }

  AlignInput input(const PaintedView& model, const PaintedFrame& frame, const Pose& start) {
    AlignInput in;
    in.points = frame.points;
    in.view = model.view;
    in.depth_z = frame.depth_z;
    in.camera = thing.camera;
    in.start = in.prior.mean = start;
    in.pivot = start.t;
    in.terms = {true, false, false};
    in.color = &frame.colors.frame;
    return in;
  }
  static double distance_mm(const Pose& a, const Pose& b) { return 1e3 * norm(a.t - b.t); }
  static double turn_deg(const Pose& a, const Pose& b) {
    return rotation_angle(a.R * b.R.transposed()) * 57.29578;
  }
};

TEST(Align, FindsThePoseThatTheFrameWasTakenAt) {
  const PaintedView model(thing, kAt, {90, 50, 250, 190});
  const Twist moves[] = {
      {{0.012, -0.004, 0.01}, {0.02, 0.05, -0.03}}, {{-0.015, 0.01, -0.012}, {-0.04, 0.02, 0.06}}, {{}, {}}};
  for (const Twist& move : moves) {
    const Pose truth = moved_about(kAt, move, kAt.t);
    const PaintedFrame frame(thing, truth);
    const AlignResult result = align(input(model, frame, kAt), work.scratch);
    CHECK(result.solved);
    CHECK_COMPARE(distance_mm(result.T_camera_object, truth), <, 0.5);
    CHECK_COMPARE(turn_deg(result.T_camera_object, truth), <, 0.2);
  }
}

TEST(Align, DividesTheWorkOfALateLoopWithoutLosingThePose) {
  const PaintedView model(thing, kAt, {90, 50, 250, 190});
  const Pose truth = moved_about(kAt, {{0.01, 0.005, 0.01}, {0.02, 0.03, -0.03}}, kAt.t);
  const PaintedFrame frame(thing, truth);
  AlignInput in = input(model, frame, kAt);
  const int all = align(in, work.scratch).depth.tried;
  in.point_stride = 4;
  const AlignResult result = align(in, work.scratch);
  CHECK_COMPARE(static_cast<std::size_t>(all), >, PointTable::kMost / 4);
  CHECK_COMPARE(static_cast<std::size_t>(result.depth.tried), <=, PointTable::kMost / 4);
  CHECK_COMPARE(distance_mm(result.T_camera_object, truth), <, 1.0);
}

TEST(Align, AHeadingFromTheMotionTurnsWhatThePictureLeavesOpen) {
  AlignInput in;
  const FlatView flat({60, 40, 100, 80}, {0, 0, -1}, -1.0f);  // a plane: its turn about the axis is unseen
  std::vector<ObservedPoint> points;
  std::vector<float> depth(160 * 120, 1.0f);
  for (int v = 42; v < 78; v += 2)
    for (int u = 62; u < 98; u += 2)
      points.push_back({kSmallCamera.ray(static_cast<float>(u), static_cast<float>(v))});
  in.points = points;
  in.view = flat.view;
  in.depth_z = {depth.data(), 160, 120};
  in.camera = kSmallCamera;
  in.start = in.prior.mean = flat.view.T_camera_object;
  in.pivot = {0, 0, 1};
  for (int i = 0; i < 6; ++i) in.prior.information[7 * i] = i < 3 ? 1e6 : 1.0;
  in.floor.up_camera = {0, 0, -1};
  in.terms = {false, false, true};
  in.heading = {true, 0.15, 0.02};
  const Mat3 turned = align(in, work.scratch).T_camera_object.R;
  DOUBLES_EQUAL(0.15, dot(rotation_to_vector(turned), in.floor.up_camera), 0.005);
}

TEST(Align, WhatNothingHoldsIsNotSolvedAndStaysWhereItWasLookedFor) {
  AlignInput in;
  const FlatView flat({60, 40, 100, 80}, {0, 0, -1}, -1.0f);
  const std::vector<float> depth(160 * 120, 1.0f);
  in.view = flat.view;
  in.depth_z = {depth.data(), 160, 120};
  in.camera = kSmallCamera;
  in.start = {rotation_from_vector({0.1, 0.2, 0.3}), {0.3, 0.2, 1.1}};
  in.terms = {false, false, false};
  const AlignResult result = align(in, work.scratch);
  CHECK_FALSE(result.solved);
  DOUBLES_EQUAL(0, norm(result.T_camera_object.t - in.start.t), 0);
  DOUBLES_EQUAL(0, rotation_angle(result.T_camera_object.R.transposed() * in.start.R), 1e-7);
}

TEST(Align, TheOutlineAloneHoldsAFlatThingSideways) {
  const PaintedView model(thing, kAt, {90, 50, 250, 190});
  const Pose truth = moved_about(kAt, {{0.014, -0.009, 0}, {}}, kAt.t);
  const PaintedFrame frame(thing, truth);
  build_view_table(model.view, work.scratch.view);
  const std::size_t outline = find_outline(work.scratch.view, thing.camera, work.scratch.outline);
  CHECK_COMPARE(outline, >, 100u);
  const ContourTermOptions options;
  const std::size_t edges = find_contour({work.scratch.outline, outline}, thing.camera, frame.depth_z, Pose{},
                                         options, work.scratch.contour);
  CHECK_COMPARE(edges * 10, >, outline * 9);
  double x = 0, y = 0;
  for (int i = 0; i < 8; ++i) {
    NormalEquations eq;
    const Pose D{Mat3{}, {x, y, 0}};
    add_contour_term({work.scratch.contour, edges}, thing.camera, D, options, eq);
    const double a = eq.H[0], b = eq.H[1], d = eq.H[NormalEquations::kSize + 1], det = a * d - b * b;
    x -= (d * eq.g[0] - b * eq.g[1]) / det;
    y -= (a * eq.g[1] - b * eq.g[0]) / det;
  }
  DOUBLES_EQUAL(0.014, x, 0.0015);
  DOUBLES_EQUAL(-0.009, y, 0.0015);
}

TEST(Align, ALongOutlineIsThinnedEvenly) {
  const PaintedView model(thing, kAt, {90, 50, 250, 190});
  build_view_table(model.view, work.scratch.view);
  const std::size_t whole = find_outline(work.scratch.view, thing.camera, work.scratch.outline);
  OutlinePoint few[40];
  const std::size_t thinned = find_outline(work.scratch.view, thing.camera, few);
  CHECK_COMPARE(thinned, >=, 20u);
  CHECK_COMPARE(thinned, <=, 40u);
  const std::size_t every = (whole + thinned - 1) / thinned;
  for (std::size_t i = 0; i < thinned; ++i) {
    const std::size_t from = i * every;
    CHECK_COMPARE(from, <, whole);
    DOUBLES_EQUAL(work.scratch.outline[from].p.x, few[i].p.x, 1e-9);
    DOUBLES_EQUAL(work.scratch.outline[from].p.y, few[i].p.y, 1e-9);
  }
}

TEST(Align, TheDepthKernelIsThePlainSumOnEveryInstructionSet) {
  const PaintedView model(thing, kAt, {90, 50, 250, 190});
  const Pose D = moved_about(Pose{}, {{0.003, -0.002, 0.004}, {0.01, 0.02, -0.01}}, kAt.t);
  const PaintedFrame frame(thing, moved_about(kAt, {{0.001, 0, 0}, {}}, kAt.t));
  DepthTermOptions options;
  options.gate_m = 0.02f;
  build_view_table(model.view, work.scratch.view);
  arrange_points(frame.points, PointTable::kMost, work.scratch.points);
  UNSIGNED_LONGS_EQUAL(frame.points.size(), work.scratch.points.count);
  const NormalEquations plain = plain_depth_term(frame, model.view, thing.camera, D, kAt.t, options);
  for (const char* name : supported_simd()) {
    CHECK(select_simd(name) == SimdChoice::kDone);
    NormalEquations eq;
    const DepthTermResult result = add_depth_term(work.scratch.points, work.scratch.points.count,
                                                  work.scratch.view, thing.camera, D, kAt.t, options, eq);
    CHECK_COMPARE(result.inliers, >, 500);
    for (int i = 0; i < 64; ++i) DOUBLES_EQUAL(plain.H[i], eq.H[i], 2e-3 * largest(plain));
    for (int i = 0; i < 6; ++i) DOUBLES_EQUAL(plain.g[i], eq.g[i], 2e-3 * std::fabs(plain.g[2]) + 1e-3);
  }
}

TEST(Align, TheColorTermsGradientIsTheSlopeOfItsResiduals) {
  const PaintedView model(thing, kAt, {90, 50, 250, 190});
  const PaintedFrame frame(thing, kAt);
  build_view_table(model.view, work.scratch.view);
  const ColorTermOptions options;
  PointTable& points = work.scratch.color_points;
  collect_color_points(work.scratch.view, thing.camera, frame.depth_z, Pose{}, options, PointTable::kMost,
                       points);
  const double no_shift[2] = {0, 0};
  // Near the truth a solved step leads back to it, in every direction that colour sees.
  for (const char* name : supported_simd()) {
    CHECK(select_simd(name) == SimdChoice::kDone);
    const double turn = 0.004;  // about the camera's axis
    const Pose then = moved_about(Pose{}, {{}, {0, 0, turn}}, kAt.t);
    NormalEquations eq;
    const ColorTermResult result =
        add_color_term({points, points.count, frame.colors.frame, then}, kAt.t, {}, no_shift, options, eq);
    CHECK_COMPARE(result.used, >, 500);
    constexpr int kTurn = 5;
    DOUBLES_EQUAL(-turn, -eq.g[kTurn] / eq.H[kTurn * NormalEquations::kSize + kTurn], 0.3 * turn);
  }
}

TEST(Align, TheGainOfADarkerExposureIsFound) {
  const PaintedView model(thing, kAt, {90, 50, 250, 190});
  const PaintedFrame frame(thing, kAt);
  const SeenColors darker(thing.camera,
                          [&](int u, int v) { return 0.8 * painted_grey(thing, kAt, u, v) + 12; });
  build_view_table(model.view, work.scratch.view);
  PointTable& points = work.scratch.color_points;
  collect_color_points(work.scratch.view, thing.camera, frame.depth_z, Pose{}, {}, PointTable::kMost, points);
  const ColorGain gain = fit_color_gain({points, points.count, darker.frame, Pose{}});
  DOUBLES_EQUAL(0.8, gain.gain, 0.02);
  DOUBLES_EQUAL(12.0, gain.offset, 2.0);
}

TEST(Align, ColoursAreTakenWhereTheModelMayBeSeen) {
  const PaintedView model(thing, kAt, {90, 50, 250, 190});
  PaintedFrame frame(thing, kAt);
  build_view_table(model.view, work.scratch.view);
  PointTable& points = work.scratch.color_points;
  const auto count = [&] {
    collect_color_points(work.scratch.view, thing.camera, frame.depth_z, Pose{}, {}, PointTable::kMost,
                         points);
    return points.available;
  };
  const std::size_t all = count();
  CHECK_COMPARE(all, >, 1000u);
  const auto left_half = [&](float depth_m) {
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 170; ++u) frame.z[static_cast<std::size_t>(v * 320 + u)] = depth_m;
  };
  left_half(0);  // it returns no depth: its colours show all the same
  UNSIGNED_LONGS_EQUAL(all, count());
  left_half(0.8f);  // something stands before it
  const std::size_t right = count();
  CHECK_COMPARE(right, <, 3 * all / 4);
  left_half(3.0f);  // it is not there
  UNSIGNED_LONGS_EQUAL(right, count());
}

TEST(Align, ColoursOfAnEarlierInstantGiveThePoseNow) {
  const PaintedView model(thing, kAt, {90, 50, 250, 190});
  // Between the images it turned on as it was expected to.
  const Pose truth = moved_about(kAt, {{0.002, 0, 0}, {0.03, 0.05, -0.04}}, kAt.t);
  const Pose motion = moved_about(Pose{}, {{}, {0, -0.03, 0.06}}, kAt.t);
  const PaintedFrame frame(thing, truth), earlier(thing, motion * truth);
  AlignInput in = input(model, frame, kAt);
  in.color = &earlier.colors.frame;
  in.color_time.motion = motion;
  const AlignResult result = align(in, work.scratch);
  CHECK_COMPARE(turn_deg(result.T_camera_object, truth), <, 0.25);
  CHECK_COMPARE(turn_deg(result.color_motion, motion), <, 0.25);
  in.color_time = {};  // as if of the same instant
  CHECK_COMPARE(turn_deg(align(in, work.scratch).T_camera_object, truth), >, 0.5);
}
