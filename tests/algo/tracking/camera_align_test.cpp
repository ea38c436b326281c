#include "algo/tracking/camera_align.hpp"

#include "algo/core/simd.hpp"
#include "algo/tracking/camera_judge.hpp"
#include "tests/algo/tracking/corner_room.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;

namespace {

const Pose kMoved{rotation_from_vector({0.02, -0.03, 0.015}), {0.03, -0.02, 0.025}};

CameraAlignResult aligned(std::span<const Wall> walls, const Pose& T_view_camera) {
  const RoomFrame view(walls, Pose{}), frame(walls, T_view_camera);
  CameraAlignInput in{frame.depth, view.view, kRoomCamera, Pose{}, {}};
  return align_camera(in);
}

double metres_off(const Pose& a, const Pose& b) { return norm(a.t - b.t); }
double radians_off(const Pose& a, const Pose& b) { return rotation_angle(a.R.transposed() * b.R); }

}  // namespace

TEST_GROUP(CameraAlign){void teardown() override{select_simd(nullptr);
}
}
;

TEST(CameraAlign, ACornerGivesTheWholePose) {
  const CameraAlignResult r = aligned(kCorner, kMoved);
  CHECK(r.solved);
  DOUBLES_EQUAL(0, metres_off(kMoved, r.T_view_camera), 2e-4);
  DOUBLES_EQUAL(0, radians_off(kMoved, r.T_view_camera), 1e-4);
  CHECK(r.inliers > 0.95 * r.paired);
  CHECK(least_seen_sigma_m(r.data_information, 1.5) < 0.001);
}

TEST(CameraAlign, EveryInstructionSetAgreesWithinRounding) {
  for (const char* name : supported_simd()) {
    select_simd(name);
    const CameraAlignResult r = aligned(kCorner, kMoved);
    CHECK_TEXT(metres_off(kMoved, r.T_view_camera) < 2e-4, name);
  }
}

TEST(CameraAlign, AFlatWallSaysItsDistanceAndThatTheRestIsUnseen) {
  const Pose nearer{Mat3{}, {0.015, 0, 0.02}};
  const CameraAlignResult r = aligned(kFlatWall, nearer);
  CHECK(r.solved);
  DOUBLES_EQUAL(0.02, r.T_view_camera.t.z, 1e-4);
  DOUBLES_EQUAL(0, r.T_view_camera.t.x, 1e-3);  // the prior holds it where it was expected
  CHECK(least_seen_sigma_m(r.data_information, 1.5) > 0.02);
  CHECK(judge_camera(r, {}).state == TrackState::kPoor);
}

TEST(CameraAlign, TheAccelerometerHoldsTheTiltThatNothingElseSees) {
  const RoomFrame empty(std::span<const Wall>{}, Pose{});
  const double lean = 0.01;
  CameraAlignInput in{empty.depth, empty.view, kRoomCamera, Pose{}, {}};
  in.prior.has_up = true;
  in.prior.sigma_up_rad = 0.001;
  in.prior.up_view = {0, -1, 0};
  in.prior.up_frame = rotation_from_vector({0, 0, -lean}) * in.prior.up_view;
  const CameraAlignResult r = align_camera(in);
  DOUBLES_EQUAL(lean, rotation_to_vector(r.T_view_camera.R).z, 1e-4);
}

TEST(CameraAlign, NothingInSightIsLost) {
  const RoomFrame view(kCorner, Pose{}), empty(std::span<const Wall>{}, Pose{});
  const CameraAlignResult r = align_camera({empty.depth, view.view, kRoomCamera, Pose{}, {}});
  LONGS_EQUAL(0, r.readings);
  CHECK(judge_camera(r, {}).state == TrackState::kLost);
}

TEST(CameraAlign, TheJudgeKnowsAGoodPoseAndOneThatExplainsLessThanUsual) {
  CameraAlignResult r = aligned(kCorner, kMoved);
  CameraHabit habit;
  CameraVerdict v = judge_camera(r, habit);
  CHECK(v.state == TrackState::kGood);
  learn(habit, v);
  DOUBLES_EQUAL(v.explained, habit.explained, 1e-6);
  r.inliers = static_cast<int>(0.7 * r.facing);
  CHECK(judge_camera(r, habit).state == TrackState::kPoor);
  r.inliers = static_cast<int>(0.3 * r.facing);
  CHECK(judge_camera(r, habit).state == TrackState::kLost);
}

TEST(CameraAlign, AJumpIsNoPose) {
  CameraAlignResult r = aligned(kCorner, kMoved);
  r.T_view_camera.t.x += 0.5;
  CHECK(judge_camera(r, {}).state == TrackState::kLost);
}
