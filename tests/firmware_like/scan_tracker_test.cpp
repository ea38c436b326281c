#include "firmware_like/scan_tracker.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include "tests/algo/tracking/corner_room.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;

namespace {

Calibration room_calibration() {
  Calibration c;
  c.depth = {kRoomCamera.width, kRoomCamera.height, kRoomCamera.fx,
             kRoomCamera.fy,    kRoomCamera.cx,     kRoomCamera.cy};
  c.encoding = DepthEncoding::kScaled16;
  c.has_color = c.color_registered = true;
  c.color = c.depth;
  return c;
}

LoopConfig room_config(double extent_m) {
  LoopConfig config;
  config.mode = Mode::kScan;
  config.volume_side = 128;
  config.place.extent_m = extent_m;
  return config;
}

// The hand goes sideways and turns a little: 6 mm and 0.2 degrees a frame.
Pose way(int frame) { return {rotation_from_vector({0, 0.003 * frame, 0}), {0.006 * frame, 0, 0}}; }

// A tracker and the camera that it follows through the room.
struct Hand {
  explicit Hand(double extent_m = 0) : tracker(room_calibration(), room_config(extent_m)) {
    tracker.plan_memory(plan);
    memory.resize(plan.bytes() + Bump::kAlign);
    void* start = memory.data();
    std::size_t room = memory.size();
    std::align(Bump::kAlign, plan.bytes(), start, room);
    plan.seal(Bump(start, room));
    tracker.start();
  }

  FrameReport see(std::span<const Wall> walls, const Pose& T_world_camera, int level = 0) {
    const LadderStep& step = ladder_step(level);
    const RoomFrame room(walls, T_world_camera);
    const ImageView<float>& z = room.depth.levels[0].z;
    std::vector<std::uint16_t> stored(static_cast<std::size_t>(z.pixels()));
    for (std::size_t i = 0; i < stored.size(); ++i)
      stored[i] = static_cast<std::uint16_t>(std::lround(z.data[i] * 1000));
    FrameInput input;
    input.t_s = input.device_t_s = static_cast<double>(frames++) / 30;
    input.depth = {stored.data(), z.width, z.height};
    input.color = {rgb.data(), 3 * z.width, z.height};
    input.color_device_t_s = input.device_t_s - color_lag_s;
    FrameReport report;
    tracker.preprocess(input, report);
    tracker.predict();
    tracker.render(step);
    tracker.align(step);
    tracker.judge();
    tracker.integrate(step);
    tracker.decide();
    tracker.publish(report);
    return report;
  }

  bool colored() const {
    for (const std::uint32_t c : tracker.scene().color)
      if (c != 0) return true;
    return false;
  }

  ScanTracker tracker;
  MemoryPlan plan;
  std::vector<std::uint8_t> memory;
  int frames = 0;
  std::vector<std::uint8_t> rgb = std::vector<std::uint8_t>(3 * kRoomCamera.width * kRoomCamera.height, 90);
  double color_lag_s = 0;
};

}  // namespace

TEST_GROUP(ScanTracker) { Hand hand; };

TEST(ScanTracker, FollowsACameraThroughARoom) {
  FrameReport report;
  for (int i = 0; i < 20; ++i) report = hand.see(kCorner, way(i));
  CHECK(report.camera.state == TrackState::kGood);
  DOUBLES_EQUAL(0, norm(report.camera.T_world_camera.t - way(19).t), 0.003);
  UNSIGNED_LONGS_EQUAL(20, hand.tracker.count().tracked);
}

TEST(ScanTracker, TheWorldBeginsAtTheFirstFrameThatSeesEnough) {
  for (int i = 0; i < 3; ++i) {
    const FrameReport report = hand.see(std::span<const Wall>{}, way(0));
    CHECK(report.camera.state == TrackState::kLost);
    CHECK(report.events.empty());  // nothing was had that could be lost
  }
  CHECK(hand.see(kCorner, way(0)).camera.state == TrackState::kGood);
  CHECK(hand.tracker.scene().extent_m() > 2);  // as far as the room goes
  CHECK(hand.see(kCorner, way(1)).camera.state == TrackState::kGood);
  UNSIGNED_LONGS_EQUAL(3, hand.tracker.count().lost);
}

TEST(ScanTracker, ALateFrameLeavesOutColourThenPixelsThenTheFusion) {
  for (int i = 0; i < 6; ++i) hand.see(kCorner, way(i), 1);
  CHECK(!hand.colored());
  hand.see(kCorner, way(6), 0);
  CHECK(hand.colored());

  const double before = hand.tracker.count().pixels_aligned;
  hand.see(kCorner, way(7), 1);
  const double full = hand.tracker.count().pixels_aligned - before;
  FrameReport report;
  for (int i = 8; i < 18; ++i) report = hand.see(kCorner, way(i), 2);
  const double halved = hand.tracker.count().pixels_aligned - before - full;
  CHECK(halved / 10 < full / 2);
  CHECK(report.camera.state == TrackState::kGood);
  DOUBLES_EQUAL(0, norm(report.camera.T_world_camera.t - way(17).t), 0.004);

  const std::uint32_t fused = hand.tracker.scene().integrations;
  UNSIGNED_LONGS_EQUAL(18, fused);
  for (int i = 18; i < 22; ++i) report = hand.see(kCorner, way(i), 3);
  UNSIGNED_LONGS_EQUAL(fused, hand.tracker.scene().integrations);
  CHECK(report.camera.state == TrackState::kGood);
  DOUBLES_EQUAL(0, norm(report.camera.T_world_camera.t - way(21).t), 0.005);
}

// The colour image is from the frame before, when the camera still stood: left half dark, right half bright.
TEST(ScanTracker, AnOlderColourImageIsLaidWhereTheCameraWasThen) {
  hand.color_lag_s = 1.0 / 30;
  for (std::size_t i = 0; i < hand.rgb.size(); ++i)
    hand.rgb[i] = static_cast<int>(i / 3) % kRoomCamera.width < kRoomCamera.width / 2 ? 20 : 220;
  for (int i = 0; i < 4; ++i) hand.see(kCorner, way(0), 1);
  CHECK(hand.see(kCorner, {Mat3{}, {0.04, 0, 0}}, 0).camera.state == TrackState::kGood);

  const Volume& v = hand.tracker.scene();
  int left = 0, right = 0, wrong = 0;
  for (int z = 0; z < v.side; ++z)
    for (int y = 0; y < v.side; ++y)
      for (int x = 0; x < v.side; ++x) {
        const std::uint32_t c = v.color[v.index(x, y, z)];
        const Vec3f p =
            v.origin + Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} * v.voxel_m;
        const float off_px = kRoomCamera.fx * p.x / p.z - 0.5f;
        if (c == 0 || std::fabs(off_px) < 2.5f || std::fabs(off_px) > 8) continue;
        const bool bright = red_of(c) > 120;
        ++(bright ? right : left);
        wrong += bright != (off_px > 0) ? 1 : 0;
      }
  CHECK(left > 50 && right > 50);
  CHECK(wrong < (left + right) / 20);
}

// Far from where it was lost, at a place that it knows.
TEST(ScanTracker, ALostCameraIsFoundAtAPlaceWhereItHasBeen) {
  int i = 0;
  for (; i < 100; ++i) hand.see(kCorner, way(i));
  for (int k = 0; k < 3; ++k) hand.see(std::span<const Wall>{}, way(i));
  FrameReport report;
  for (int k = 0; k < 10; ++k) report = hand.see(kCorner, way(12));
  CHECK(report.camera.state == TrackState::kGood);
  DOUBLES_EQUAL(0, norm(report.camera.T_world_camera.t - way(12).t), 0.005);
}

// A small volume: turned aside the camera looks out of it, turned down to the floor it looks into it.
TEST(ScanTracker, TheBorderOfTheVolumeIsToldEachTimeItIsLeft) {
  Hand small(2.2);
  int told = 0;
  const auto turn = [&](const Vec3& axis, double from_rad, double to_rad) {
    for (int i = 0; i < 20; ++i) {
      const double angle = from_rad + (to_rad - from_rad) * i / 20;
      for (const Event& event : small.see(kCorner, {rotation_from_vector(axis * angle), {}}).events) {
        CHECK(event.kind == EventKind::kVolumeLeft);
        CHECK(event.a > 0.6 && event.a < 0.65);
        ++told;
      }
    }
  };
  const Vec3 aside{0, 1, 0}, down{-1, 0, 0};
  turn(aside, 0, 0.26);
  LONGS_EQUAL(1, told);
  turn(aside, 0.26, 0);
  turn(down, 0, 0.3);
  turn(down, 0.3, 0);
  turn(aside, 0, 0.26);
  LONGS_EQUAL(2, told);
}

TEST(ScanTracker, LostAndRecoveredTellTheTimeWithoutAPose) {
  for (int i = 0; i < 10; ++i) hand.see(kCorner, way(i));
  const FrameReport lost = hand.see(std::span<const Wall>{}, way(10));
  LONGS_EQUAL(1, lost.events.size());
  CHECK(lost.events[0].kind == EventKind::kLost);
  DOUBLES_EQUAL(1.0 / 30, lost.events[0].a, 1e-9);
  for (int i = 0; i < 4; ++i) hand.see(std::span<const Wall>{}, way(10));
  FrameReport report;
  for (int i = 0; i < 12 && report.events.empty(); ++i) report = hand.see(kCorner, way(10));
  CHECK(report.events.size() == 1 && report.events[0].kind == EventKind::kRecovered);
  CHECK(report.camera.state == TrackState::kGood);
  DOUBLES_EQUAL(report.events[0].t_s - 9.0 / 30, report.events[0].a, 1e-9);
}
