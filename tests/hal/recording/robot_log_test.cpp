#include "hal/recording/robot_log.hpp"

#include <CppUTest/TestHarness.h>

#include "hal/recording/open_recording.hpp"
#include "tests/support/fake_recording.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/temp_folder.hpp"

using namespace st;
using namespace st::test;

namespace {

// Stands in for the robot's protocol: every received byte is a sample of that many millimetres.
RobotBytes millimetres(RobotModel, const std::optional<RobotGeometry>&, OdometrySink sink) {
  return [sink](double t_s, bool rx, std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t b : bytes)
      if (rx) sink({t_s, b * 1e-3, b * 2e-3});
  };
}

}  // namespace

TEST_GROUP(RobotLog) {
  TempFolder folder;
  Seen read() {
    SourceOptions options;
    options.spec = folder.path();
    return read_all(*open_recording(options, millimetres));
  }
};

TEST(RobotLog, LinesRoundTrip) {
  const std::uint8_t bytes[] = {0x00, 0x9a, 0xff};
  const std::string line = format_robot_log_line(1400101000.030870, true, bytes);
  STRCMP_EQUAL("1400101000.030870 rx 009aff\n", line.c_str());
  RobotLogEntry entry;
  CHECK(parse_robot_log_line(line.substr(0, line.size() - 1) + "\r", entry) == LineKind::kEntry);
  DOUBLES_EQUAL(1400101000.030870, entry.t_s, 1e-7);
  CHECK(entry.rx);
  UNSIGNED_LONGS_EQUAL(3, entry.bytes.size());
  LONGS_EQUAL(0x9a, entry.bytes[1]);
  CHECK(parse_robot_log_line("1.5 tx 8A", entry) == LineKind::kEntry && !entry.rx);
  CHECK(parse_robot_log_model(robot_log_first_line(RobotModel::kCreate1).substr(0, 15)) ==
        RobotModel::kCreate1);
  CHECK(parse_robot_log_model("# model create2") == RobotModel::kCreate2);
}

TEST(RobotLog, KeepsTheWheelsThatItWasWrittenWith) {
  const RobotGeometry measured{0.2381, 0.0713, 508.8};
  std::string line_read = robot_log_wheels_line(measured);
  line_read.pop_back();
  const auto read = parse_robot_log_wheels(line_read);
  CHECK(read.has_value());
  DOUBLES_EQUAL(0.2381, read->wheel_base_m, 1e-9);
  DOUBLES_EQUAL(0.0713, read->wheel_diameter_m, 1e-9);
  DOUBLES_EQUAL(508.8, read->counts_per_turn, 1e-9);
  for (const char* line : {"# wheels 0.2 0.07", "# wheels 0.2 0 508", "# wheels -1 1 1", "1.0 rx 00", ""})
    CHECK(!parse_robot_log_wheels(line));
}

TEST(RobotLog, WhatIsNoLineIsForeign) {
  RobotLogEntry entry;
  for (const char* line : {"1.0 rx 0", "1.0 rx", "1.0 rz 00", "x rx 00", "1.0 rx 0g", "inf rx 00"})
    CHECK(parse_robot_log_line(line, entry) == LineKind::kForeign);
  CHECK(parse_robot_log_line("# a comment", entry) == LineKind::kBlank);
  CHECK(!parse_robot_log_model("# model create3"));
}

TEST(RobotLog, OdometryComesWithTheFrameThatFollowsIt) {
  write_camera_toml(folder.path(), false);
  for (int k = 0; k < 3; ++k) add_depth(folder.path(), k, 500);
  write_file(folder / "robot.log", "# model create2\n" +
                                       std::string("1000.010000 rx 05\n1000.020000 tx 07\nrubbish\n") +
                                       "1000.050000 rx 0102\n1009.000000 rx 09\n");
  const Seen seen = read();
  UNSIGNED_LONGS_EQUAL(0, seen.frames[0].input.odometry.size());
  UNSIGNED_LONGS_EQUAL(1, seen.frames[1].input.odometry.size());
  DOUBLES_EQUAL(5e-3, seen.frames[1].input.odometry[0].left_m, 1e-12);
  UNSIGNED_LONGS_EQUAL(2, seen.frames[2].input.odometry.size());
  UNSIGNED_LONGS_EQUAL(1, seen.events(EventKind::kDamaged).size());
  DOUBLES_EQUAL(3.0, seen.events(EventKind::kDamaged)[0].c, 0);
}

TEST(RobotLog, FramesCsvSaysHowMuchHadArrived) {
  write_camera_toml(folder.path(), false);
  for (int k = 0; k < 3; ++k) add_depth(folder.path(), k, 500);
  const std::string first = "# model create1\n", second = "1000.010000 rx 05\n",
                    third = "1000.011000 rx 06\n";
  write_file(folder / "robot.log", first + second + third);
  std::string rows = "depth_ticks,colour_ticks,level,robot_log_offset\n";
  const std::size_t offsets[] = {0, first.size() + second.size(),
                                 first.size() + second.size() + third.size()};
  for (int k = 0; k < 3; ++k)
    rows += std::to_string(ticks_of(k)) + ",,0," + std::to_string(offsets[k]) + "\n";
  write_file(folder / "frames.csv", rows);
  const Seen seen = read();
  UNSIGNED_LONGS_EQUAL(0, seen.frames[0].input.odometry.size());
  UNSIGNED_LONGS_EQUAL(1, seen.frames[1].input.odometry.size());
  UNSIGNED_LONGS_EQUAL(1, seen.frames[2].input.odometry.size());
}

TEST(RobotLog, MoreSamplesThanAFrameHoldsLoseNoTravel) {
  write_camera_toml(folder.path(), false);
  for (int k = 0; k < 2; ++k) add_depth(folder.path(), k, 500);
  std::string log = "# model create1\n";
  for (int i = 0; i < 100; ++i) log += "1000.0" + std::to_string(10 + i % 10) + " rx 01\n";
  write_file(folder / "robot.log", log);
  const Seen seen = read();
  double left_m = 0;
  for (const OdometrySample& sample : seen.frames[1].input.odometry) left_m += sample.left_m;
  UNSIGNED_LONGS_EQUAL(64, seen.frames[1].input.odometry.size());
  DOUBLES_EQUAL(0.1, left_m, 1e-12);
}
