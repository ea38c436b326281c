// The paper's ICP as printed: steps 1 to 3 on clouds whose motion is known.
#include "algo/tracking/closest_point.hpp"

#include <CppUTest/TestHarness.h>

#include <vector>

#include "algo/core/scalar_math.hpp"
#include "algo/tracking/observe.hpp"
#include "algo/tracking/rigid_fit.hpp"
#include "tests/algo/volume/analytic_view.hpp"
#include "tests/support/bound.hpp"

using namespace st;
using namespace st::test;

namespace {

constexpr double kDegree = kPi / 180;
constexpr Pinhole kCamera{288, 288, 159.5f, 119.5f, 320, 240};
const Pose kAt{rotation_from_vector({0.3, 0.5, -0.2}), {0.05, -0.03, 1.3}};

double distance_m(const Pose& a, const Pose& b) { return norm(a.t - b.t); }
double turn_rad(const Pose& a, const Pose& b) { return rotation_angle(a.R.transposed() * b.R); }

}  // namespace

TEST_GROUP(RigidFit){};

TEST(RigidFit, FindsAnyRigidMotionExactly) {
  const Vec3 points[] = {{0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.3}, {-0.1, 0.05, 0.1}, {0.2, -0.1, -0.2}};
  const Vec3 turns[] = {{0, 0, 0}, {0.02, -0.01, 0.03}, {1.5, 0.4, -0.8}, {kPi - 1e-3, 0, 0}, {0, 0, kPi}};
  for (const Vec3& turn : turns) {
    const Pose truth{rotation_from_vector(turn), {0.3, -1.2, 2.0}};
    RigidFit fit;
    for (const Vec3& p : points) fit.add(p, truth * p);
    Pose found;
    CHECK(fit.solve(found));
    CHECK(distance_m(truth, found) < 1e-12);
    CHECK(turn_rad(truth, found) < 1e-7);  // as far as the angle of a matrix can be told
  }
}

// Points on a plane leave a mirror image as good a fit; it must not be taken for a turn.
TEST(RigidFit, GivesATurnAndNoReflectionForPointsOnAPlane) {
  RigidFit fit;
  const Vec3 points[] = {{0.1, 0, 0}, {0, 0.2, 0}, {-0.1, 0.05, 0}, {0.2, -0.1, 0}};
  const Pose truth{rotation_from_vector({0.2, 0.3, 2.0}), {0, 0.1, 1}};
  for (const Vec3& p : points) fit.add(p, truth * p);
  Pose found;
  CHECK(fit.solve(found));
  DOUBLES_EQUAL(1, dot(found.R.col(0), cross(found.R.col(1), found.R.col(2))), 1e-12);
  CHECK(turn_rad(truth, found) < 1e-7);
}

TEST(RigidFit, WantsThreePairs) {
  RigidFit fit;
  Pose found;
  fit.add({0, 0, 0}, {1, 0, 0});
  fit.add({0, 0, 1}, {1, 0, 1});
  CHECK_FALSE(fit.solve(found));
}

TEST_GROUP(ClosestPoint) {
  Bench bench{128, 320, 240};
  std::mt19937 random{5};
  ModelCloud model;
  AlignScratch scratch;
  BoundMemory memory{[this](Bump& bump) {
    model.bind(bump);
    scratch.bind(bump, 320, 240);
  }};
  std::vector<ObservedPoint> points{20000};

  // The model of a box from noise-free views around it, as the loop's volume has it.
  void learn(const Solid& solid) {
    bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
    for (int i = 0; i < 10; ++i)
      bench.fuse(render(solid, looking_at(1.3, 0.6 * i, 0.6), {}, random, kCamera));
    model.take(bench.volume);
  }
  // A noise-free copy of a part of the model's cloud, as the camera would have it at T.
  std::span<const ObservedPoint> copy_at(const Pose& T) {
    std::size_t n = 0;
    for (const Vec3f& p : model.tree.points())
      if (n < points.size() && p.x > -0.05f) points[n++].p = to_float(T * to_double(p));
    return {points.data(), n};
  }
  std::span<const ObservedPoint> seen(const Solid& solid, const Pose& T, View& frame) {
    Rendering how;
    how.noise = 1;
    frame = render(solid, T, how, random, kCamera);
    const std::size_t n =
        gather_points({frame.depth.data(), kCamera.width, kCamera.height},
                      {frame.owners.data(), kCamera.width, kCamera.height}, 1, frame.roi, kCamera, points);
    return {points.data(), n};
  }
};

TEST(ClosestPoint, RecoversTheMotionOfANoiseFreeCopyToAMicrometre) {
  learn(Box({0.16, 0.12, 0.07}));
  const Twist moves[] = {{{0.002, -0.001, 0.0015}, {}},
                         {{}, {0.006, -0.01, 0.008}},
                         {{-0.001, 0.002, 0.001}, {-0.005, 0.004, 0.01}}};
  for (const Twist& move : moves) {
    const Pose truth = moved_about(kAt, move, kAt.t);
    ClosestPointOptions options;
    options.settled_share = 0;
    options.points = 4000;
    const ClosestPointResult found = closest_point_icp(copy_at(truth), model.tree, kAt, options);
    CHECK(distance_m(truth, found.T_camera_object) < 1e-6);
    CHECK(turn_rad(truth, found.T_camera_object) < 1e-6);
    CHECK(found.iterations < ClosestPointOptions::kMostIterations);
  }
}

// Besl & McKay's theorem 1: neither step can raise the error.
TEST(ClosestPoint, TheMeanSquaredErrorNeverRises) {
  const Box box({0.16, 0.12, 0.07});
  learn(box);
  for (const double size : {0.2, 1.0, 3.0}) {
    const Pose truth =
        moved_about(kAt, {Vec3{0.03, -0.02, 0.02} * size, Vec3{0.05, 0.1, -0.08} * size}, kAt.t);
    View frame;
    ClosestPointOptions options;
    options.settled_share = 1e-7;
    const ClosestPointResult found = closest_point_icp(seen(box, truth, frame), model.tree, kAt, options);
    CHECK(found.iterations > 5);
    for (int i = 1; i < found.iterations; ++i)
      CHECK(found.mean_square_m2[i] <= found.mean_square_m2[i - 1] * (1 + 1e-6));
  }
}

TEST(ClosestPoint, TheWorkHasABoundThatTheDataDoNotMove) {
  const Box box({0.16, 0.12, 0.07});
  learn(box);
  View frame;
  ClosestPointOptions options;
  options.settled_share = -1;  // never settled
  options.settled_m2 = -1;
  const ClosestPointResult found = closest_point_icp(seen(box, kAt, frame), model.tree, kAt, options);
  LONGS_EQUAL(ClosestPointOptions::kMostIterations, found.iterations);
}

TEST(ClosestPoint, FindsAFrameInTheModelAndSaysWhatTheJudgeAsks) {
  const Box box({0.16, 0.12, 0.07});
  learn(box);
  const Pose start = looking_at(1.3, 0.5, 0.6);
  raycast(bench.volume, kCamera, {0, 0, kCamera.width, kCamera.height}, start, bench.raycasting, bench.maps);
  const Pose truth = moved_about(start, {{0.012, -0.004, 0.006}, {0.01, -0.05, 0.02}}, start.t);
  View frame;
  AlignInput in;
  in.points = seen(box, truth, frame);
  in.view = {bench.maps, start};
  in.depth_z = {frame.depth.data(), kCamera.width, kCamera.height};
  in.camera = kCamera;
  in.start = in.prior.mean = start;
  in.pivot = start.t;
  const AlignResult found = align_closest_point(in, model, scratch);
  CHECK(found.solved);
  DOUBLES_EQUAL(0, distance_m(truth, found.T_camera_object), 0.004);
  DOUBLES_EQUAL(0, turn_rad(truth, found.T_camera_object), 1.5 * kDegree);
  CHECK(found.depth.inliers * 10 > found.depth.tried * 8);
  for (int i = 0; i < 6; ++i) CHECK(found.covariance[7 * i] > 0 && found.covariance[7 * i] < 1e-3);
}

// Projective association and closest points are two ways to the same pose where both find it.
TEST(ClosestPoint, AgreesWithProjectiveIcpOnSmallMotions) {
  const Box box({0.16, 0.12, 0.07});
  learn(box);
  const Pose start = looking_at(1.3, 0.5, 0.6);
  raycast(bench.volume, kCamera, {0, 0, kCamera.width, kCamera.height}, start, bench.raycasting, bench.maps);
  const Twist moves[] = {
      {{0.01, 0, 0}, {}}, {{0, -0.008, 0.01}, {0, 0, 0.03}}, {{-0.006, 0.006, 0}, {0.02, -0.03, 0}}};
  for (const Twist& move : moves) {
    View frame;
    AlignInput in;
    in.points = seen(box, moved_about(start, move, start.t), frame);
    in.view = {bench.maps, start};
    in.depth_z = {frame.depth.data(), kCamera.width, kCamera.height};
    in.camera = kCamera;
    in.start = in.prior.mean = start;
    in.pivot = start.t;
    in.terms = {false, false, false};
    const AlignResult closest = align_closest_point(in, model, scratch), projective = align(in, scratch);
    CHECK(closest.solved && projective.solved);
    DOUBLES_EQUAL(0, distance_m(closest.T_camera_object, projective.T_camera_object), 0.004);
    DOUBLES_EQUAL(0, turn_rad(closest.T_camera_object, projective.T_camera_object), 1.0 * kDegree);
  }
}

TEST(ClosestPoint, AnEmptyModelSolvesNothing) {
  View frame;
  AlignInput in;
  in.points = seen(Box({0.16, 0.12, 0.07}), kAt, frame);
  in.start = kAt;
  model.tree.build(0);
  CHECK_FALSE(align_closest_point(in, model, scratch).solved);
}
