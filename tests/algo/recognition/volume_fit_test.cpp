#include "algo/recognition/volume_fit.hpp"

#include "algo/core/scalar_math.hpp"
#include "tests/algo/volume/analytic_view.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

constexpr double kPitch = 0.5;

// A print that has one heading only.
std::uint32_t print_at(const Vec3& p) {
  const bool bright = p.x > 0.03 || (p.y > 0.05 && p.z > 0);
  const std::uint8_t grey = bright ? 210 : 70;
  return pack_rgb(grey, grey, static_cast<std::uint8_t>(grey / 2));
}

struct Thing {
  explicit Thing(const Solid& solid, const std::vector<double>& yaws, double noise = 0.3) : bench(128) {
    bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
    std::mt19937 random(5);
    Rendering how;
    how.noise = noise;
    how.paint = print_at;
    for (const double yaw : yaws) bench.fuse(render(solid, looking_at(1.1, yaw, kPitch), how, random));
    std::vector<Vec3f> scratch(kFitPoints);
    points.resize(kFitPoints);
    points.resize(sample_surface(bench.volume, points, scratch).points);
  }
  Bench bench;
  std::vector<SurfacePoint> points;
};

std::vector<double> all_round() {
  std::vector<double> yaws;
  for (int i = 0; i < 12; ++i) yaws.push_back(2 * kPi * i / 12);
  return yaws;
}

// Towards the camera of looking_at(), in the object's frame.
Vec3f viewer(double yaw) { return to_float(normalized(Vec3{-sin_cos(yaw).sin, -sin_cos(yaw).cos, 0})); }

// The best of many headings, as a search does it.
VolumeFit search(const Thing& model, const Thing& seen, double seen_yaw) {
  VolumeFit best;
  for (int i = 0; i < 36; ++i) {
    Pose start;
    if (!start_from_silhouette(model.points, seen.points, viewer(seen_yaw), 2 * kPi * i / 36, start))
      continue;
    const VolumeFit fit = fit_to_volume(model.bench.volume, {seen.points}, start, 8);
    if (fit.score() > best.score()) best = fit;
  }
  return best;
}

}  // namespace

TEST_GROUP(VolumeFit){};

TEST(VolumeFit, AViewFindsItsPlaceOnTheWholeModel) {
  const Box box({0.10, 0.06, 0.05});
  const Thing model(box, all_round());
  for (const double yaw : {0.3, 2.0, 4.4}) {
    const Thing seen(box, {yaw});
    const VolumeFit fit = search(model, seen, yaw);
    CHECK_TRUE(fit.explained > 0.9f);
    CHECK_TRUE(fit.likeness > 0.7f);
    CHECK_TRUE(norm(fit.T_model_seen.t) < 0.004);
    CHECK_TRUE(rotation_angle(fit.T_model_seen.R) < 0.03);
  }
}

TEST(VolumeFit, ThePrintDecidesTheHeadingOfADisc) {
  const Disc disc(0.15, 0.05);
  const Thing model(disc, all_round()), seen(disc, {1.0, 1.1});
  const VolumeFit fit = search(model, seen, 1.05);
  CHECK_TRUE(rotation_angle(fit.T_model_seen.R) < 0.12);
  CHECK_TRUE(fit.likeness > 0.7f);
}

TEST(VolumeFit, AnotherShapeIsNotExplained) {
  const Thing model(Box({0.10, 0.06, 0.05}), all_round());
  const Thing seen(Disc(0.09, 0.05), {0.4});
  CHECK_TRUE(search(model, seen, 0.4).explained < 0.8f);  // what is known explains 0.88 at least
}

TEST(VolumeFit, TheSilhouetteLeavesTheOutliersOut) {
  std::vector<SurfacePoint> points;
  for (int i = 0; i <= 200; ++i) points.push_back({{0.1f, 0.001f * static_cast<float>(i), 0}, -1});
  points.push_back({{0.1f, 1.0f, 0}, -1});
  const Silhouette s = silhouette(points, {1, 0, 0});
  DOUBLES_EQUAL(0.1, static_cast<double>(s.nearest), 0.03);
  DOUBLES_EQUAL(0.1, static_cast<double>(s.middle()), 0.01);
  DOUBLES_EQUAL(0.19, static_cast<double>(s.width()), 0.03);
}

// The alignment holds a disc's place but not its turn; the print turns it.
TEST(VolumeFit, TurningToThePrintFindsTheHeadingThatTheShapeLeavesOpen) {
  const Disc disc(0.15, 0.05);
  const Thing model(disc, all_round()), seen(disc, {1.0, 1.1});
  const Pose start{rotation_z(0.12), {}};
  const SeenSurface surface{seen.points};
  const VolumeFit placed = fit_to_volume(model.bench.volume, surface, start, 12);
  const VolumeFit turned = turn_to_print(model.bench.volume, surface, placed, 8, 0.02);
  CHECK_TRUE(turned.score() > placed.score());
  CHECK_TRUE(rotation_angle(placed.T_model_seen.R) > 0.1);
  CHECK_TRUE(rotation_angle(turned.T_model_seen.R) < 0.05);
}

// Floor that hangs on to a thing is no part of its surface, and its box still reaches down to it.
TEST(VolumeFit, TheSkirtIsLeftOutAndTheBoxReachesTheFloor) {
  const Thing box(Box({0.10, 0.06, 0.05}), all_round());
  const float skirt = skirt_m(0.10f);
  DOUBLES_EQUAL(0.035, static_cast<double>(skirt), 1e-6);
  DOUBLES_EQUAL(0.04, static_cast<double>(skirt_m(0.5f)), 1e-6);
  for (const SurfacePoint& point : box.points) CHECK_TRUE(point.p.z > -0.05f + skirt - 0.006f);
  std::vector<SurfacePoint> points(kFitPoints);
  std::vector<Vec3f> scratch(kFitPoints);
  const Bounds bounds = sample_surface(box.bench.volume, points, scratch).bounds;
  CHECK_TRUE(bounds.low.z < -0.03);
  DOUBLES_EQUAL(0.05, bounds.high.z, 0.006);
  DOUBLES_EQUAL(0.10, bounds.high.x, 0.008);
}
