#include "hal/recording/recorder.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <filesystem>

#include "hal/error.hpp"
#include "hal/recording/camera_file.hpp"
#include "hal/source/stamp_clock.hpp"
#include "tests/support/fake_recording.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/temp_folder.hpp"

using namespace st;
using namespace st::test;

TEST_GROUP(Recorder) {
  TempFolder folder;
  std::vector<std::uint16_t> depth = std::vector<std::uint16_t>(kWidth * kHeight);
  std::vector<std::uint8_t> color = std::vector<std::uint8_t>(3 * kWidth * kHeight);

  RecorderOptions options(unsigned queue_frames = 64) {
    write_camera_toml(folder / "source", true);
    RecorderOptions o;
    o.folder = folder / "rec";
    o.calibration = read_camera_file(folder / "source/camera.toml", CameraKind::kKinect);
    o.queue_frames = queue_frames;
    return o;
  }
  FrameInput frame(int k) {
    FrameInput f;
    f.index = static_cast<std::uint64_t>(k);
    f.t_s = host_of(k);
    f.device_t_s = ticks_of(k) / kKinectTicksPerSecond;
    depth.assign(depth.size(), static_cast<std::uint16_t>(400 + k));
    f.depth = {depth.data(), kWidth, kHeight};
    if (k > 0) {
      const int taken = k - k % 2;  // every second frame brings a new colour
      color.assign(color.size(), static_cast<std::uint8_t>(taken));
      f.color = {color.data(), 3 * kWidth, kHeight};
      f.color_device_t_s = (1.0 * ticks_of(taken) - 500'000.0) / kKinectTicksPerSecond;
      f.color_is_new = k % 2 == 0;
    }
    f.has_gravity = true;
    f.gravity_mps2 = {0.3, -9.2, -3.1};
    return f;
  }
};

TEST(Recorder, WhatIsRecordedReadsBackTheSame) {
  {
    Recorder recorder(options());
    for (int k = 0; k < 20; ++k) CHECK(recorder.add(frame(k), k % 3, 0));
    recorder.close();
    UNSIGNED_LONGS_EQUAL(20, recorder.written());
    UNSIGNED_LONGS_EQUAL(0, recorder.dropped());
  }
  const Seen seen = read_all(folder / "rec");
  UNSIGNED_LONGS_EQUAL(20, seen.frames.size());
  UNSIGNED_LONGS_EQUAL(0, seen.events(EventKind::kDamaged).size());
  for (int k = 0; k < 20; ++k) {
    const SeenFrame& back = seen.frames[static_cast<std::size_t>(k)];
    const FrameInput original = frame(k);
    CHECK(back.depth == depth);
    if (k > 0) CHECK(back.color == color);
    CHECK_EQUAL(k == 0, back.color.empty());
    DOUBLES_EQUAL(original.t_s, back.input.t_s, 1e-6);
    DOUBLES_EQUAL(original.device_t_s, back.input.device_t_s, 1e-12);
    DOUBLES_EQUAL(original.color_device_t_s, back.input.color_device_t_s, 1e-12);
    LONGS_EQUAL(k % 3, back.input.recorded_level);
    for (int i = 0; i < 3; ++i) DOUBLES_EQUAL(original.gravity_mps2[i], back.input.gravity_mps2[i], 0.012);
  }
  LONGS_EQUAL(kWidth, seen.info.calibration.depth.width);
}

TEST(Recorder, AFullQueueDropsAndCounts) {
  // A writer that cannot get on: INDEX.txt's lines go to a pipe that nobody empties would block for ever, so
  // instead the queue is filled faster than any disk can take it.
  Recorder recorder(options(1));
  std::uint64_t taken = 0;
  for (int k = 0; k < 2000; ++k) taken += recorder.add(frame(k), 0, 0);
  recorder.close();
  UNSIGNED_LONGS_EQUAL(2000 - taken, recorder.dropped());
  UNSIGNED_LONGS_EQUAL(taken, recorder.written());
  CHECK(recorder.dropped() > 0);
}

TEST(Recorder, AFolderThatIsNotEmptyIsRefused) {
  write_file(folder / "rec/precious.txt", "x");
  try {
    Recorder recorder(options());
    FAIL("took a folder that is not empty");
  } catch (const Failure& failure) {
    STRCMP_CONTAINS("is not empty", failure.what());
  }
  STRCMP_EQUAL("x", read_file(folder / "rec/precious.txt").c_str());
}

TEST(Recorder, AWriteThatFailsIsSaidOnceAndLeavesNoHalfFile) {
  Recorder recorder(options());
  CHECK(recorder.add(frame(0), 0, 0));
  while (recorder.written() < 1) CHECK(recorder.wait_for_room(1000));
  std::filesystem::remove_all(folder / "rec");  // the disk goes away
  CHECK(recorder.add(frame(1), 0, 0));
  recorder.close();
  STRCMP_CONTAINS("cannot be written", recorder.failure().c_str());
  UNSIGNED_LONGS_EQUAL(1, recorder.written());
  CHECK(!recorder.add(frame(2), 0, 0));
}

TEST(Recorder, DepthInPngUnitsIsRefused) {
  RecorderOptions o = options();
  o.calibration.encoding = DepthEncoding::kScaled16;
  CHECK_THROWS(Failure, Recorder{o});
}
