// Known small motions of bodies with a print, rendered analytically, must come back out of align().
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <optional>

#include "algo/core/scalar_math.hpp"
#include "algo/tracking/align.hpp"
#include "algo/tracking/align_beside.hpp"
#include "algo/tracking/observe.hpp"
#include "tests/algo/tracking/seen_colors.hpp"
#include "tests/algo/volume/analytic_view.hpp"
#include "tests/support/bound.hpp"

using namespace st;
using namespace st::test;

namespace {

constexpr double kDegree = kPi / 180;
constexpr Pinhole kCamera{288, 288, 159.5f, 119.5f, 320, 240};

// A print without symmetry, smooth enough for a pixel's step.
std::uint32_t print(const Vec3& p) {
  const double wave = sin_cos(28 * p.x + 9 * p.y).sin * sin_cos(21 * p.y - 13 * p.x + 0.7).cos;
  const auto grey = static_cast<std::uint8_t>(120 + 80 * wave);
  return pack_rgb(grey, grey, grey);
}

MotionPrior weak_prior(const Pose& mean) {
  MotionPrior prior;
  prior.mean = mean;
  for (int i = 0; i < 6; ++i) prior.information[7 * i] = i < 3 ? 1 / (0.03 * 0.03) : 1 / (0.2 * 0.2);
  return prior;
}

}  // namespace

TEST_GROUP(KnownMotion) {
  Bench bench{128, 320, 240};
  std::mt19937 random{5};
  std::vector<ObservedPoint> points{20000};
  AlignScratch scratch;
  BoundMemory memory{[this](Bump& bump) { scratch.bind(bump, 320, 240); }};
  Pose T0;
  View frame;
  std::optional<SeenColors> colors;

  // The model from some frames at T0, and the view of it there.
  ModelView learn(const Solid& solid, const Pose& T) {
    T0 = T;
    Rendering how;
    how.noise = 1;
    how.paint = print;
    bench.volume.reset(0.005f, 0.02f, {0, 0, 0});
    for (int i = 0; i < 10; ++i) bench.fuse(render(solid, T0, how, random, kCamera));
    ModelView view;
    raycast(bench.volume, kCamera, {0, 0, kCamera.width, kCamera.height}, T0, bench.raycasting, bench.maps);
    view.maps = bench.maps;
    view.T_camera_object = T0;
    return view;
  }

  // The frame's colours through a camera of another exposure.
  const ColorFrame& see(double gain, double offset) {
    colors.emplace(kCamera, [&](int u, int v) {
      return gain * (frame.color[static_cast<std::size_t>(v * kCamera.width + u)] & 255u) + offset;
    });
    return colors->frame;
  }

  // What the camera sees at T, as input that starts at T0.
  AlignInput look(const Solid& solid, const ModelView& view, const Pose& T, bool color = true) {
    Rendering how;
    how.noise = 1;
    if (color) how.paint = print;
    frame = render(solid, T, how, random, kCamera);
    AlignInput in;
    if (color) in.color = &see(1, 0);
    in.depth_z = {frame.depth.data(), kCamera.width, kCamera.height};
    const std::size_t n = gather_points(in.depth_z, {frame.owners.data(), kCamera.width, kCamera.height}, 1,
                                        frame.roi, kCamera, points);
    in.points = {points.data(), n};
    in.view = view;
    in.camera = kCamera;
    in.start = T0;
    in.pivot = T0.t;
    in.prior = weak_prior(T0);
    return in;
  }

  static double position_error(const Pose& a, const Pose& b) { return norm(a.t - b.t); }
  static double turn_error(const Pose& a, const Pose& b) { return rotation_angle(a.R.transposed() * b.R); }
};

TEST(KnownMotion, FindsTheMotionOfAPrintedBox) {
  const Box box({0.16, 0.12, 0.07});
  const ModelView view = learn(box, looking_at(1.3, 0.4, 0.6));
  const Twist motions[] = {{{0.012, 0, 0}, {}},
                           {{0, 0.008, -0.01}, {}},
                           {{}, {0, 0.05, 0}},
                           {{-0.008, 0.004, 0.006}, {0.02, -0.04, 0.015}}};
  for (const Twist& motion : motions) {
    const Pose T = moved_about(T0, motion, T0.t);
    const AlignResult result = align(look(box, view, T), scratch);
    CHECK(result.solved);
    DOUBLES_EQUAL(0, position_error(T, result.T_camera_object), 0.0015);
    DOUBLES_EQUAL(0, turn_error(T, result.T_camera_object), 0.5 * kDegree);
  }
}

TEST(KnownMotion, OnlyThePrintShowsTheTurnOfARoundBody) {
  const Disc disc(0.17, 0.04);
  const ModelView view = learn(disc, looking_at(1.3, 0.0, 0.6));
  const Vec3 up = T0.R.col(2);
  const double turn = 2.5 * kDegree;
  const Pose T = moved_about(T0, {{}, up * turn}, T0.t);
  const AlignResult with = align(look(disc, view, T, true), scratch);
  const AlignResult without = align(look(disc, view, T, false), scratch);
  CHECK(with.solved && without.solved);
  DOUBLES_EQUAL(0, turn_error(T, with.T_camera_object), 0.5 * kDegree);
  DOUBLES_EQUAL(turn, turn_error(T, without.T_camera_object), 0.8 * kDegree);  // stays where the prior had it
  // And it says so: the turn about up is far less sure.
  CHECK(turn_sigma_rad(without.data_information, up) > 5 * turn_sigma_rad(with.data_information, up));
  DOUBLES_EQUAL(0, position_error(T, without.T_camera_object), 0.003);
}

TEST(KnownMotion, ATurnBeyondTheReachOfColourIsFoundBeside) {
  const Disc disc(0.17, 0.04);
  const ModelView view = learn(disc, looking_at(1.3, 0.0, 0.6));
  const Vec3 up = T0.R.col(2);
  const auto tight = [&](AlignInput in) {  // it stood, and is expected to stand
    for (int i = 3; i < 6; ++i) in.prior.information[7 * i] = 1 / (0.005 * 0.005);
    in.color_time.tie.R_frame_camera = T0.R.transposed();
    return in;
  };
  Habit habit;
  for (int i = 0; i < 20; ++i) habit.learn(align(tight(look(disc, view, T0)), scratch), {});
  for (const double turn : {0.0, 1 * kDegree, 9 * kDegree, -10 * kDegree}) {
    const Pose T = moved_about(T0, {{}, up * turn}, T0.t);
    const AlignInput in = tight(look(disc, view, T));
    AlignResult result = align(in, scratch);
    const double alone = turn_error(T, result.T_camera_object);
    Mat3 turned;
    const bool beside = align_beside(in, habit, up, scratch, result, turned);
    CHECK_EQUAL(std::fabs(turn) > 5 * kDegree, beside);
    DOUBLES_EQUAL(0, turn_error(T, result.T_camera_object), 1.0 * kDegree);
    if (!beside) continue;
    CHECK(alone > 3 * kDegree);
    DOUBLES_EQUAL(turn, dot(rotation_to_vector(turned), up), kDegree);
  }
}

TEST(KnownMotion, TheColourCamerasExposureDoesNotMatter) {
  const Box box({0.16, 0.12, 0.07});
  const ModelView view = learn(box, looking_at(1.3, 0.4, 0.6));
  const Pose T = moved_about(T0, {{0.006, 0, 0}, {0, 0.03, 0}}, T0.t);
  AlignInput in = look(box, view, T);
  in.color = &see(0.8, 15);
  const AlignResult result = align(in, scratch);
  DOUBLES_EQUAL(0.8, result.gain.gain, 0.08);
  DOUBLES_EQUAL(0, turn_error(T, result.T_camera_object), 0.5 * kDegree);
}

TEST(KnownMotion, SomethingStrangeAmongThePointsIsOutvoted) {
  const Box box({0.16, 0.12, 0.07});
  const ModelView view = learn(box, looking_at(1.3, 0.4, 0.6));
  const Pose T = moved_about(T0, {{0.006, 0.003, 0}, {}}, T0.t);
  const AlignInput in = look(box, view, T);
  for (std::size_t i = 0; i < in.points.size(); i += 5) points[i].p = points[i].p * 0.96f;  // 5 cm nearer
  const AlignResult result = align(in, scratch);
  DOUBLES_EQUAL(0, position_error(T, result.T_camera_object), 0.004);
  CHECK(result.depth.inliers < result.depth.tried * 9 / 10);
}

TEST(KnownMotion, TheFloorHoldsHeightAndUpright) {
  const Box box({0.16, 0.12, 0.07});
  const ModelView view = learn(box, looking_at(1.3, 0.4, 0.6));
  const Vec3 up = T0.R.col(2);
  AlignInput in = look(box, view, T0);
  in.points = {};  // nothing but priors
  in.terms.contour = false;
  in.color = nullptr;
  in.floor.on = true;
  in.floor.up_camera = up;
  in.floor.d = -dot(up, T0.t);  // the floor goes through the origin
  in.start = moved_about(T0, {up * 0.008, {0.03, 0, 0}}, T0.t);
  in.prior.mean = in.start;
  const AlignResult held = align(in, scratch);
  DOUBLES_EQUAL(0, dot(up, held.T_camera_object.t - T0.t), 2e-4);
  DOUBLES_EQUAL(1, dot(up, held.T_camera_object.R.col(2)), 1e-5);
  in.floor.on = false;
  const AlignResult free = align(in, scratch);
  DOUBLES_EQUAL(0.008, dot(up, free.T_camera_object.t - T0.t), 1e-6);
}

TEST(KnownMotion, CovarianceShrinksWithWhatIsSeen) {
  const Box box({0.16, 0.12, 0.07});
  const ModelView view = learn(box, looking_at(1.3, 0.4, 0.6));
  AlignInput in = look(box, view, T0);
  const AlignResult seen = align(in, scratch);
  in.points = in.points.subspan(0, 60);
  in.terms.contour = false;
  in.color = nullptr;
  const AlignResult hardly = align(in, scratch);
  for (int i = 0; i < 6; ++i) {
    CHECK(seen.covariance[7 * i] > 0);
    CHECK(seen.covariance[7 * i] < hardly.covariance[7 * i]);
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j) DOUBLES_EQUAL(seen.covariance[6 * i + j], seen.covariance[6 * j + i], 1e-12);
}
