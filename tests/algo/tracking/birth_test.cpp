// Where an object's frame lies, how large its volume is, and where in the image it can be.
#include "algo/tracking/birth.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <memory>
#include <vector>

#include "algo/core/scalar_math.hpp"
#include "algo/tracking/image_box.hpp"
#include "tests/algo/tracking/flat_view.hpp"
#include "tests/support/bound.hpp"

using namespace st;
using namespace st::test;

namespace {

constexpr double kHeight_m = 1.1, kPitch_rad = 0.5;

// The camera stands kHeight_m above the floor and looks down by kPitch_rad.
const Vec3 kUp{0, -std::cos(kPitch_rad), -std::sin(kPitch_rad)};
const Support kFloor = make_support(kUp, kHeight_m, true);

// The visible sides of a box on the floor: `ahead_m` along the floor from below the camera, `side_m` to the
// right.
std::vector<ObservedPoint> box_points(double ahead_m, double side_m, const Vec3& size, double lift_m = 0) {
  const Mat3& R = kFloor.R_camera_floor;
  const Vec3 below = kUp * -kHeight_m;
  const Vec3 ahead = R.col(0), left = R.col(1);
  std::vector<ObservedPoint> points;
  const auto add = [&](double a, double b, double h) {
    const Vec3 p = below + ahead * (ahead_m + a) + left * (b - side_m) + kUp * (lift_m + h);
    points.push_back({to_float(p)});
  };
  constexpr int kSteps = 40;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const double s = static_cast<double>(i) / kSteps, t = static_cast<double>(j) / kSteps;
      add(size.x * (s - 0.5), size.y * (t - 0.5), size.z);  // top
      add(-0.5 * size.x, size.y * (t - 0.5), size.z * s);   // front
    }
  return points;
}

}  // namespace

TEST_GROUP(Birth){};

TEST(Birth, SupportsAxesAreRightHandedAndZIsUp) {
  const Mat3& R = kFloor.R_camera_floor;
  DOUBLES_EQUAL(0, norm(R.col(2) - kUp), 1e-12);
  DOUBLES_EQUAL(0, norm(cross(R.col(0), R.col(1)) - R.col(2)), 1e-12);
  DOUBLES_EQUAL(0, R.col(0).x, 1e-12);  // the camera's axis laid on the floor
  CHECK(R.col(0).z > 0);
  DOUBLES_EQUAL(kHeight_m, kFloor.height_of({0, 0, 0}), 1e-12);
}

TEST(Birth, OriginIsBelowTheMiddleOnTheFloor) {
  const Footprint f = find_footprint(box_points(1.6, 0.3, {0.3, 0.4, 0.1}), kFloor);
  CHECK(f.on_floor);
  const Vec3 expected = kUp * -kHeight_m + kFloor.R_camera_floor * Vec3{1.6, -0.3, 0};
  DOUBLES_EQUAL(0, norm(f.T_camera_object.t - expected), 0.006);
  DOUBLES_EQUAL(0, kFloor.height_of(f.T_camera_object.t), 1e-9);
  DOUBLES_EQUAL(0, rotation_angle(f.T_camera_object.R.transposed() * kFloor.R_camera_floor), 1e-6);
  const Vec3 size = f.bounds.size();
  DOUBLES_EQUAL(0.3, size.x, 0.015);
  DOUBLES_EQUAL(0.4, size.y, 0.015);
  DOUBLES_EQUAL(0.1, size.z, 0.005);
}

TEST(Birth, AFewStrayPointsDoNotMoveIt) {
  std::vector<ObservedPoint> points = box_points(1.6, 0.3, {0.3, 0.4, 0.1});
  const Footprint clean = find_footprint(points, kFloor);
  for (int i = 0; i < 10; ++i) points.push_back({to_float(Vec3{0.5 + 0.02 * i, 0, 2.2})});
  const Footprint f = find_footprint(points, kFloor);
  DOUBLES_EQUAL(0, norm(f.T_camera_object.t - clean.T_camera_object.t), 0.01);
}

TEST(Birth, WhatIsCarriedDoesNotStandOnTheFloor) {
  const Footprint f = find_footprint(box_points(1.6, 0, {0.3, 0.3, 0.1}, 0.5), kFloor);
  CHECK(!f.on_floor);
  DOUBLES_EQUAL(0.5, f.bounds.low.z, 0.01);
  Support none = kFloor;
  none.found = false;
  const Footprint without = find_footprint(box_points(1.6, 0, {0.3, 0.3, 0.1}, 0.5), none);
  CHECK(!without.on_floor);
  DOUBLES_EQUAL(0, without.bounds.low.z, 0.01);  // its own lowest level
}

TEST(Birth, TheVolumeLeavesRoomForWhatIsNotSeenYet) {
  const auto track = std::make_unique<Track>();
  const test::BoundMemory memory([&](Bump& bump) { track->volume.bind(bump, 128); });
  for (const double side : {0.08, 0.35, 0.6}) {
    const Footprint f = find_footprint(box_points(1.6, 0, {side, side, 0.1}), kFloor);
    start_track(*track, f, kFloor, 12.5);
    CHECK(track->phase == Track::Phase::kCandidate);
    LONGS_EQUAL(0, track->id);
    const double extent = static_cast<double>(track->volume.extent_m());
    CHECK(extent > 1.5 * side);
    CHECK(extent > 0.45);
    DOUBLES_EQUAL(0, norm(to_double(track->volume.centre()) - f.bounds.centre()), 0.01);
    DOUBLES_EQUAL(0, norm(track->motion.pose().t - f.T_camera_object.t), 0);
  }
}

TEST(Birth, ATrackKnowsNothingOfWhoHadItsSlotBefore) {
  const auto track = std::make_unique<Track>();
  const test::BoundMemory memory([&](Bump& bump) { track->volume.bind(bump, 64); });
  track->id = 7;
  track->left_view = track->told_full = track->heading_doubt = true;
  track->yaw_unwrapped = 700;
  track->owned_pixels = track->divided_run = track->cut_balance = track->double_run = 99;
  track->good_poses = track->poor_run = track->integrated = track->still_run = track->lost_run = 99;
  track->T_last_good.t = {9, 9, 9};
  track->yaw_source = YawSource::kColor;
  track->verdict = Verdict::kGood;
  const Footprint f = find_footprint(box_points(1.6, 0, {0.3, 0.3, 0.1}), kFloor);
  start_track(*track, f, kFloor, 3);
  LONGS_EQUAL(0, track->id);
  CHECK_FALSE(track->left_view || track->told_full || track->heading_doubt || track->cut());
  DOUBLES_EQUAL(0, track->yaw_unwrapped, 0);
  LONGS_EQUAL(0, track->owned_pixels + track->divided_run + track->double_run + track->good_poses +
                     track->poor_run + track->integrated + track->still_run + track->lost_run);
  DOUBLES_EQUAL(0, norm(track->T_last_good.t - f.T_camera_object.t), 0);
  CHECK(track->yaw_source == YawSource::kNone);
  CHECK(track->verdict == Verdict::kLost);
}

TEST_GROUP(ImageBox){};

TEST(ImageBox, HoldsEveryCornerAndLittleMore) {
  Bounds bounds;
  bounds.include({-0.2, -0.1, 0});
  bounds.include({0.2, 0.1, 0.3});
  const Pose T{rotation_from_vector({1.9, 0.3, 0}), {0.1, 0.05, 1.6}};
  const Rect box = image_box(bounds, T, kSmallCamera, 3), tight = image_box(bounds, T, kSmallCamera, 0);
  LONGS_EQUAL(tight.u0 - 3, box.u0);
  LONGS_EQUAL(tight.v1 + 3, box.v1);
  double least_u = 1e9, most_u = -1e9;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = T * Vec3{corner & 1 ? 0.2 : -0.2, corner & 2 ? 0.1 : -0.1, corner & 4 ? 0.3 : 0.0};
    const double u = kSmallCamera.fx * p.x / p.z + kSmallCamera.cx;
    least_u = u < least_u ? u : least_u;
    most_u = u > most_u ? u : most_u;
  }
  LONGS_EQUAL(static_cast<int>(std::floor(least_u)), tight.u0);
  LONGS_EQUAL(static_cast<int>(std::ceil(most_u)) + 1, tight.u1);
}

TEST(ImageBox, OnTopOfTheCameraItIsTheWholeImage) {
  Bounds bounds;
  bounds.include({-0.2, -0.2, 0});
  bounds.include({0.2, 0.2, 0.3});
  const Rect box = image_box(bounds, {{}, {0, 0, 0.1}}, kSmallCamera, 5);
  LONGS_EQUAL(0, box.u0);
  LONGS_EQUAL(160, box.u1);
  LONGS_EQUAL(120, box.v1);
}

TEST(ImageBox, OutsideOfTheImageItStaysOutside) {
  Bounds bounds;
  bounds.include({-0.1, -0.1, 0});
  bounds.include({0.1, 0.1, 0.1});
  CHECK(image_box(bounds, {{}, {3, 0, 1}}, kSmallCamera, 0).clipped(160, 120).empty());
  CHECK(image_box({}, {{}, {0, 0, 1}}, kSmallCamera, 0).empty());
}
