#include <CppUTest/TestHarness.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "hal/error.hpp"
#include "hal/recording/fakenect_index.hpp"
#include "hal/source/stamp_clock.hpp"
#include "tests/support/fake_recording.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/temp_folder.hpp"

using namespace st;
using namespace st::test;

TEST_GROUP(Fakenect) {
  TempFolder folder;

  void setup() override { write_camera_toml(folder.path(), true); }
  std::string depth_name(int k) { return fakenect_name('d', host_of(k), ticks_of(k)); }
  void add_depths(int from, int to) {
    for (int k = from; k < to; ++k) add_depth(folder.path(), k, 500 + k);
  }
  void check_one_damaged(const Seen& seen, std::size_t frames, DamageReason reason) {
    const std::vector<Event> events = seen.events(EventKind::kDamaged);
    UNSIGNED_LONGS_EQUAL(frames, seen.frames.size());
    UNSIGNED_LONGS_EQUAL(1, events.size());
    DOUBLES_EQUAL(1.0, events[0].a, 0);
    DOUBLES_EQUAL(static_cast<double>(reason), events[0].b, 0);
  }
};

TEST(Fakenect, DeliversPixelsStampsAndIndexInOrder) {
  add_depths(0, 20);
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(20, seen.frames.size());
  CHECK(seen.end == FrameSource::Result::kEnd);
  UNSIGNED_LONGS_EQUAL(20, seen.info.expected_frames);
  DOUBLES_EQUAL(1.0 / 30.0, seen.info.frame_period_s, 1e-9);
  for (int k = 0; k < 20; ++k) {
    const SeenFrame& frame = seen.frames[static_cast<std::size_t>(k)];
    UNSIGNED_LONGS_EQUAL(static_cast<unsigned>(k), frame.input.index);
    UNSIGNED_LONGS_EQUAL(kWidth * kHeight, frame.depth.size());
    for (const std::uint16_t value : frame.depth) LONGS_EQUAL(500 + k, value);
    DOUBLES_EQUAL(host_of(k), frame.input.t_s, 1e-6);
    LONGS_EQUAL(ticks_of(k), std::llround(frame.input.device_t_s * kKinectTicksPerSecond));
    CHECK(frame.input.events.empty());
  }
}

TEST(Fakenect, CarriageReturnsAndBlankLinesAreNoDamage) {
  add_depths(0, 3);
  std::string index = read_file(folder / "INDEX.txt");
  for (std::size_t at = 0; (at = index.find('\n', at)) != std::string::npos; at += 4)
    index.replace(at, 1, "\r\n\r\n");
  write_file(folder / "INDEX.txt", index);
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(3, seen.frames.size());
  UNSIGNED_LONGS_EQUAL(0, seen.events(EventKind::kDamaged).size());
}

TEST(Fakenect, AMissingFileIsSkippedAndTold) {
  add_depths(0, 6);
  std::filesystem::remove(folder / depth_name(3));
  const Seen seen = read_all(folder.path());
  check_one_damaged(seen, 5, DamageReason::kMissing);
  UNSIGNED_LONGS_EQUAL(1, seen.events(EventKind::kGap).size());  // and it leaves a gap of one frame
  DOUBLES_EQUAL(1.0, seen.events(EventKind::kGap)[0].b, 0);
  LONGS_EQUAL(504, seen.frames[3].depth[0]);
}

TEST(Fakenect, AShortFileIsSkippedAndTold) {
  add_depths(0, 6);
  std::filesystem::resize_file(folder / depth_name(2), 40);
  check_one_damaged(read_all(folder.path()), 5, DamageReason::kShort);
}

TEST(Fakenect, AShortLastFileIsToldWithTheLastFrame) {
  add_depths(0, 6);
  std::filesystem::resize_file(folder / depth_name(5), 40);
  check_one_damaged(read_all(folder.path()), 5, DamageReason::kShort);
}

TEST(Fakenect, AFrameOfAnotherSizeIsSkippedAndTold) {
  add_depths(0, 3);
  add_named(folder.path(), depth_name(3), pgm(700, 16, 4));
  add_depths(4, 6);
  check_one_damaged(read_all(folder.path()), 5, DamageReason::kWrongSize);
}

TEST(Fakenect, ForeignLinesAndFilesAreSkippedAndTold) {
  add_depths(0, 3);
  append_file(folder / "INDEX.txt", "notes.txt\n../d-1000.100000-7000000.pgm\n");
  add_named(folder.path(), depth_name(3), "hello, this is no image at all");
  add_depths(4, 6);
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(5, seen.frames.size());
  const std::vector<Event> events = seen.events(EventKind::kDamaged);
  UNSIGNED_LONGS_EQUAL(3, events.size());
  for (std::size_t i = 0; i < 3; ++i)
    DOUBLES_EQUAL(static_cast<double>(DamageReason::kForeign), events[i].b, 0);
  DOUBLES_EQUAL(3.0, events[2].a, 0);
}

TEST(Fakenect, StampsThatRepeatOrGoBackwardsAreSkippedAndTold) {
  add_depths(0, 4);
  add_depth(folder.path(), 3, 503);                                                         // again
  add_named(folder.path(), fakenect_name('d', host_of(4), ticks_of(1)), pgm(901));          // ticks go back
  add_named(folder.path(), fakenect_name('d', host_of(1) + 0.001, ticks_of(5)), pgm(902));  // host goes back
  add_depths(6, 9);
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(7, seen.frames.size());
  UNSIGNED_LONGS_EQUAL(3, seen.events(EventKind::kDamaged).size());
  for (std::size_t i = 1; i < seen.frames.size(); ++i) {
    CHECK(seen.frames[i].input.t_s > seen.frames[i - 1].input.t_s);
    CHECK(seen.frames[i].input.device_t_s > seen.frames[i - 1].input.device_t_s);
    CHECK(seen.frames[i].depth[0] < 900);
  }
}

TEST(Fakenect, MoreDamageThanAFrameCanTellIsToldWithTheNextAndCountedRight) {
  add_depths(0, 2);
  for (int k = 2; k < 42; ++k) append_file(folder / "INDEX.txt", depth_name(k) + "\n");
  add_depths(42, 44);
  for (int k = 44; k < 64; ++k) append_file(folder / "INDEX.txt", depth_name(k) + "\n");
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(4, seen.frames.size());
  UNSIGNED_LONGS_EQUAL(16, seen.frames[2].input.events.size());
  UNSIGNED_LONGS_EQUAL(16, seen.frames[3].input.events.size());
  DOUBLES_EQUAL(60.0, seen.frames[3].input.events[15].a, 0);
}

TEST(Fakenect, TheCounterWrapsWithoutANotch) {
  const std::uint32_t near_wrap = 0xffffffffu - 5'000'000u;
  for (int k = 0; k < 8; ++k) add_depth(folder.path(), k, 600, near_wrap);
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(8, seen.frames.size());
  for (std::size_t i = 1; i < 8; ++i)
    DOUBLES_EQUAL(1.0 / 30.0, seen.frames[i].input.device_t_s - seen.frames[i - 1].input.device_t_s, 1e-9);
  UNSIGNED_LONGS_EQUAL(0, seen.events(EventKind::kGap).size());
}

TEST(Fakenect, AGapOfManyWrapsIsMeasuredByTheHostAndTheTicks) {
  add_depths(0, 3);
  const int later = 30 * 1000;  // 1000 s: nearly 14 wraps
  add_depth(folder.path(), later, 600);
  add_depth(folder.path(), later + 1, 600);
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(5, seen.frames.size());
  DOUBLES_EQUAL((later - 2) / 30.0, seen.frames[3].input.device_t_s - seen.frames[2].input.device_t_s, 1e-6);
}

TEST(Fakenect, ColourIsTheNewestThatIsNotLater) {
  add_color(folder.path(), 0, 10);
  add_depth(folder.path(), 1, 500);
  add_depth(folder.path(), 2, 500);  // no newer colour: the same again
  add_color(folder.path(), 3, 13);
  add_color(folder.path(), 5, 15);  // listed before the depth frame, but taken after it
  add_depth(folder.path(), 4, 500);
  add_depth(folder.path(), 6, 500);
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(4, seen.frames.size());
  const int expected[] = {10, 10, 13, 15};
  const bool is_new[] = {true, false, true, true};
  const int taken[] = {0, 0, 3, 5};
  for (std::size_t i = 0; i < 4; ++i) {
    UNSIGNED_LONGS_EQUAL(3 * kWidth * kHeight, seen.frames[i].color.size());
    LONGS_EQUAL(expected[i], seen.frames[i].color[0]);
    CHECK_EQUAL(is_new[i], seen.frames[i].input.color_is_new);
    LONGS_EQUAL(ticks_of(taken[i]),
                std::llround(seen.frames[i].input.color_device_t_s * kKinectTicksPerSecond));
  }
}

TEST(Fakenect, DamagedColourLeavesTheColourBefore) {
  add_color(folder.path(), 0, 10);
  add_depth(folder.path(), 1, 500);
  add_color(folder.path(), 2, 12);
  std::filesystem::resize_file(folder / fakenect_name('r', host_of(2), ticks_of(2)), 30);
  add_depth(folder.path(), 3, 500);
  const Seen seen = read_all(folder.path());
  check_one_damaged(seen, 2, DamageReason::kShort);
  LONGS_EQUAL(10, seen.frames[1].color[0]);
  DOUBLES_EQUAL(1.0, seen.events(EventKind::kDamaged)[0].c, 0);
}

TEST(Fakenect, FramesCsvSaysWhichColourAndLevelWereUsed) {
  add_color(folder.path(), 0, 10);
  add_depth(folder.path(), 1, 500);
  add_color(folder.path(), 2, 12);
  add_depth(folder.path(), 3, 500);
  add_depth(folder.path(), 4, 500);
  add_depth(folder.path(), 5, 500);
  write_file(folder / "frames.csv",
             "depth_ticks,colour_ticks,level,robot_log_offset\n" + std::to_string(ticks_of(1)) + ",,0,0\n" +
                 std::to_string(ticks_of(2)) + ",77,9,0\n" +  // its depth frame never reached the disk
                 std::to_string(ticks_of(3)) + "," + std::to_string(ticks_of(0)) + ",2,0\n" +
                 std::to_string(ticks_of(5)) + "," + std::to_string(ticks_of(2)) + ",1,0\n");
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(4, seen.frames.size());
  CHECK(seen.frames[0].color.empty());
  LONGS_EQUAL(10, seen.frames[1].color[0]);
  LONGS_EQUAL(2, seen.frames[1].input.recorded_level);
  LONGS_EQUAL(12, seen.frames[2].color[0]);  // no row: the rule
  LONGS_EQUAL(0, seen.frames[2].input.recorded_level);
  LONGS_EQUAL(1, seen.frames[3].input.recorded_level);
}

TEST(Fakenect, HeadersOverSeveralLinesAreRead) {
  add_depths(0, 2);
  const std::string one_line = pgm(700);
  add_named(folder.path(), depth_name(2),
            "P5\n# a comment\n8 4\n65535\n" + one_line.substr(one_line.find('\n') + 1));
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(3, seen.frames.size());
  for (const std::uint16_t value : seen.frames[2].depth) LONGS_EQUAL(700, value);
}

TEST(Fakenect, ABigEndianRecordingIsRefusedByName) {
  for (int k = 0; k < 4; ++k) add_depth(folder.path(), k, (500 & 255) << 8 | 500 >> 8);
  STRCMP_CONTAINS("big-endian", why_not(folder.path()).c_str());
}

TEST(Fakenect, MillimetresAreRefused) {
  for (int k = 0; k < 4; ++k) add_depth(folder.path(), k, 0x0b0b);
  STRCMP_CONTAINS("not raw 11-bit", why_not(folder.path()).c_str());
}

TEST(Fakenect, AllOfAWrongSizeIsBadInput) {
  for (int k = 0; k < 4; ++k) add_named(folder.path(), depth_name(k), pgm(600, 16, 8));
  STRCMP_CONTAINS("16x8 pixels, calibration says 8x4", why_not(folder.path()).c_str());
}

TEST(Fakenect, ColourOfAWrongSizeIsBadInput) {
  add_named(folder.path(), fakenect_name('r', host_of(0), ticks_of(0)), ppm(1, 16, 8));
  add_depths(1, 4);
  STRCMP_CONTAINS("16x8 pixels, calibration says 8x4", why_not(folder.path()).c_str());
}

TEST(Fakenect, FewerThanTwoUsableFramesIsBadInput) {
  add_depths(0, 1);
  append_file(folder / "INDEX.txt", depth_name(1) + "\n");
  STRCMP_CONTAINS("1 usable depth frames of 2, 2 are needed", why_not(folder.path()).c_str());
  add_depths(2, 3);
  STRCMP_EQUAL("", why_not(folder.path()).c_str());
}

TEST(Fakenect, WhatIsNoRecordingIsRefusedInOneLine) {
  STRCMP_CONTAINS("no such recording", why_not(folder / "nowhere").c_str());
  STRCMP_CONTAINS("is a file", why_not(folder / "camera.toml").c_str());
  STRCMP_CONTAINS("expected INDEX.txt", why_not(folder.path()).c_str());
  std::filesystem::create_directories(folder / "empty");
  STRCMP_CONTAINS("is empty", why_not(folder / "empty").c_str());
  write_file(folder / "INDEX.txt", "");
  STRCMP_CONTAINS("no depth frame is listed", why_not(folder.path()).c_str());
}

TEST(Fakenect, RealPaceWaitsAndFastDoesNot) {
  add_depths(0, 3);
  SourceOptions options;
  options.spec = folder.path();
  options.real_pace = true;
  const auto source = open_source(options);
  source->start();
  FrameInput first, second;
  CHECK(source->next(first, 10'000) == FrameSource::Result::kFrame);
  CHECK(source->next(second, 0) == FrameSource::Result::kTimeout);  // not due, and not skipped
  CHECK(source->next(second, 10'000) == FrameSource::Result::kFrame);
  LONGS_EQUAL(1, second.index);
  DOUBLES_EQUAL(1e9 / 30.0, static_cast<double>(second.complete_ns - first.complete_ns), 1000.0);
}

TEST(Fakenect, StoppingEarlyEnds) {
  add_depths(0, 30);
  SourceOptions options;
  options.spec = folder.path();
  const auto source = open_source(options);
  source->start();
  FrameInput frame;
  CHECK(source->next(frame, 10'000) == FrameSource::Result::kFrame);
  source->stop();
  source->stop();
  CHECK(source->next(frame, 10) == FrameSource::Result::kEnd);
}

TEST(Fakenect, RealCanHasElevenDepthAndColourFromTheSecondOn) {
  const std::string can = recording("can");
  if (can.empty()) return;
  const Seen seen = read_all(can);
  UNSIGNED_LONGS_EQUAL(11, seen.frames.size());
  UNSIGNED_LONGS_EQUAL(0, seen.events(EventKind::kDamaged).size());
  CHECK(seen.frames[0].color.empty());
  CHECK(!seen.frames[0].input.has_gravity);
  UNSIGNED_LONGS_EQUAL(640 * 480, seen.frames[10].depth.size());
  UNSIGNED_LONGS_EQUAL(640 * 480 * 3, seen.frames[10].color.size());
  CHECK(seen.frames[10].input.has_gravity);
  DOUBLES_EQUAL(-9.8, seen.frames[10].input.gravity_mps2.y, 0.5);
  CHECK(!seen.info.calibration_note.empty());
  STRCMP_EQUAL("can", seen.info.short_name.c_str());
}

TEST(Fakenect, RealHandWaveHasSixGaps) {
  const std::string wave = recording("hand-wave");
  if (wave.empty()) return;
  const Seen seen = read_all(wave);
  UNSIGNED_LONGS_EQUAL(98, seen.frames.size());
  UNSIGNED_LONGS_EQUAL(0, seen.events(EventKind::kDamaged).size());
  const std::vector<Event> gaps = seen.events(EventKind::kGap);
  UNSIGNED_LONGS_EQUAL(6, gaps.size());
  double missing = 0;
  for (const Event& gap : gaps) missing += gap.b;
  DOUBLES_EQUAL(14.0, missing, 0);  // 98 of 112
  CHECK(seen.frames[97].color.empty());
}
