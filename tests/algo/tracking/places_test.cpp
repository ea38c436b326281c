#include "algo/tracking/places.hpp"

#include <algorithm>

#include "algo/tracking/camera_motion.hpp"
#include "tests/algo/tracking/corner_room.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;

namespace {

Pose turned(double yaw_rad, double ahead_m = 0) {
  return {rotation_from_vector({0, yaw_rad, 0}), {0, 0, ahead_m}};
}

}  // namespace

TEST_GROUP(Places) {
  Places places;
  BoundMemory memory{[this](Bump& bump) { places.bind(bump); }};
};

TEST(Places, TheViewMostLikeTheFrameComesFirst) {
  for (int i = -2; i <= 2; ++i) {
    const RoomFrame seen(kCorner, turned(0.25 * i));
    places.remember(turned(0.25 * i), seen.depth.levels[0].z);
  }
  UNSIGNED_LONGS_EQUAL(5, places.size());
  const RoomFrame now(kCorner, turned(0.27));
  const Thumbnail seen = thumbnail_of(now.depth.levels[0].z);
  float before = 0;
  for (std::size_t rank = 0; rank < places.size(); ++rank) {
    const Places::Match match = places.like(seen, rank);
    CHECK(match.difference >= before);
    before = match.difference;
  }
  DOUBLES_EQUAL(0.25, rotation_to_vector(places.like(seen, 0).T_world_camera.R).y, 1e-9);
}

TEST(Places, AViewFromNearlyTheSamePlaceIsKeptOnce) {
  const RoomFrame seen(kCorner, Pose{});
  places.remember(Pose{}, seen.depth.levels[0].z);
  places.remember(turned(0.05), seen.depth.levels[0].z);
  UNSIGNED_LONGS_EQUAL(1, places.size());
  places.remember(turned(0.25), seen.depth.levels[0].z);
  places.remember(turned(0, 0.2), seen.depth.levels[0].z);
  UNSIGNED_LONGS_EQUAL(3, places.size());
}

TEST(Places, TheOldestMakesRoom) {
  const RoomFrame seen(kCorner, Pose{});
  for (std::size_t i = 0; i < Places::kMost + 3; ++i)
    places.remember(turned(0, 0.2 * static_cast<double>(i)), seen.depth.levels[2].z);
  UNSIGNED_LONGS_EQUAL(Places::kMost, places.size());
  // All look the same: their order does not matter, who is there does.
  const Thumbnail any = thumbnail_of(seen.depth.levels[2].z);
  double nearest = 1e9, farthest = 0;
  for (std::size_t rank = 0; rank < places.size(); ++rank) {
    const double ahead = places.like(any, rank).T_world_camera.t.z;
    nearest = std::min(nearest, ahead);
    farthest = std::max(farthest, ahead);
  }
  DOUBLES_EQUAL(0.2 * 3, nearest, 1e-9);
  DOUBLES_EQUAL(0.2 * (Places::kMost + 2), farthest, 1e-9);
}

TEST(Places, NothingSeenIsLikeNothing) {
  const RoomFrame empty(std::span<const Wall>{}, Pose{}), corner(kCorner, Pose{});
  const Thumbnail nothing = thumbnail_of(empty.depth.levels[0].z);
  CHECK(difference(nothing, thumbnail_of(corner.depth.levels[0].z)) > 1e6f);
}

TEST_GROUP(CameraMotion){};

TEST(CameraMotion, GoesOnAtItsSpeedAndStopsAfterAGap) {
  CameraMotion motion;
  const Vec3 spin{0, 0.3, 0};
  const auto at = [&](double t) { return Pose{rotation_from_vector(spin * t), {0.2 * t, 0, 0}}; };
  motion.take(1.0, at(1.0));
  DOUBLES_EQUAL(0.2, motion.predict(1.1).t.x, 1e-9);  // one pose says nothing of speed
  motion.take(1.1, at(1.1));
  DOUBLES_EQUAL(0.24, motion.predict(1.2).t.x, 1e-9);
  DOUBLES_EQUAL(0.36, rotation_to_vector(motion.predict(1.2).R).y, 1e-9);
  DOUBLES_EQUAL(0.22, motion.predict(2.0).t.x, 1e-9);
  // The step from now to then, seen from now.
  const Pose then = motion.last() * motion.moved_within(0.05);
  DOUBLES_EQUAL(0.23, then.t.x, 1e-9);
  motion.restart(3.0, at(0));
  DOUBLES_EQUAL(0, motion.predict(3.03).t.x, 1e-9);
}
