#include "hal/sim/sim_source.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include "hal/clock.hpp"
#include "hal/create/sim_state_file.hpp"
#include "hal/error.hpp"
#include "hal/sim/robot_state_reader.hpp"
#include "tests/support/temp_folder.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;

namespace {

// A state file as the simulated Create publishes it.
class StateFile {
 public:
  void put(std::int64_t ns, double x, double yaw = 0, double v = 0) {
    writer_.publish({ns, x, 0, yaw, v, v, v, 0});
  }
  std::string path() const { return folder_ / "state"; }

 private:
  TempFolder folder_;
  SimStateWriter writer_{path()};
};

}  // namespace

TEST_GROUP(RobotStateReader) { StateFile file; };

TEST(RobotStateReader, InterpolatesBetweenEntriesAndCarriesOnAfterTheLast) {
  const sim::RobotStateReader reader(file.path());
  Pose2 pose;
  CHECK(!reader.pose_at(0, pose));
  for (int i = 0; i <= 100; ++i) file.put(i * 1'000'000, 0.001 * i, 0, 1.0);
  CHECK(reader.pose_at(50'250'000, pose));
  DOUBLES_EQUAL(0.05025, pose.x, 1e-12);
  CHECK(reader.pose_at(110'000'000, pose));
  DOUBLES_EQUAL(0.110, pose.x, 1e-9);
  CHECK(reader.pose_at(9'000'000'000, pose));
  DOUBLES_EQUAL(0.150, pose.x, 1e-9);
  CHECK(reader.pose_at(-5, pose));
  DOUBLES_EQUAL(0, pose.x, 1e-12);
}

TEST(RobotStateReader, StillInterpolatesWhenTheRingHasGoneRound) {
  const sim::RobotStateReader reader(file.path());
  for (std::int64_t i = 0; i < 5000; ++i) file.put(i * 1'000'000, 0.001 * static_cast<double>(i));
  Pose2 pose;
  CHECK(reader.pose_at(4'800'500'000, pose));
  DOUBLES_EQUAL(4.8005, pose.x, 1e-9);
}

TEST(RobotStateReader, RefusesAFileThatIsNone) {
  CHECK_THROWS(Failure, sim::RobotStateReader("/tmp/startrack-there-is-none"));
  std::ofstream(file.path(), std::ios::in | std::ios::binary) << "none";  // over its first bytes, the magic
  CHECK_THROWS(Failure, sim::RobotStateReader(file.path()));
}

TEST_GROUP(SimSource) {
  SourceOptions options;
  FrameInput frame;
  void setup() override { options.spec = "sim:lab"; }
};

TEST(SimSource, DeliversDepthAndTheColourBeforeIt) {
  const auto source = open_sim_source(options);
  STRCMP_EQUAL("sim:lab", source->info().name.c_str());
  STRCMP_EQUAL("sim-lab", source->info().short_name.c_str());
  CHECK(source->info().live);
  source->start();
  double before = -1;
  int colored = 0;
  std::uint64_t expected = 0;
  for (int i = 0; i < 4; ++i) {
    CHECK(source->next(frame, 5000) == FrameSource::Result::kFrame);
    CHECK(frame.device_t_s > before);
    before = frame.device_t_s;
    UNSIGNED_LONGS_EQUAL(expected + static_cast<std::uint64_t>(frame.skipped), frame.index);
    expected = frame.index + 1;
    LONGS_EQUAL(640, frame.depth.width);
    CHECK(frame.has_gravity);
    if (!frame.color.empty()) {
      ++colored;
      CHECK(frame.color_device_t_s < frame.device_t_s);
      LONGS_EQUAL(3 * 640, frame.color.width);
    }
    CHECK(frame.complete_ns <= system_clock().monotonic_ns());
  }
  CHECK(colored >= 3);
  source->stop();
  source->stop();
  CHECK(source->next(frame, 0) == FrameSource::Result::kTimeout || frame.index >= expected);
}

TEST(SimSource, TheRobotStandsWhereTheStateFileSays) {
  // Two runs of the same room, the robot in two places: what differs lies at those two places.
  const Pose T_camera_room = sim_camera_room(options);
  const auto mean_z_at = [&](double x_m, double look_x_m) {
    StateFile file;
    file.put(1, x_m);
    options.robot_state_path = file.path();
    const auto source = open_sim_source(options);
    source->start();
    CHECK(source->next(frame, 5000) == FrameSource::Result::kFrame);
    source->stop();
    const Calibration& c = source->info().calibration;
    const Vec3 p = T_camera_room * Vec3{look_x_m, 0, 0.08};
    const int u = static_cast<int>(c.depth.fx * p.x / p.z + c.depth.cx),
              v = static_cast<int>(c.depth.fy * p.y / p.z + c.depth.cy);
    double sum = 0;
    int n = 0;
    for (int dv = -4; dv <= 4; ++dv)
      for (int du = -4; du <= 4; ++du) {
        const int raw = frame.depth(u + du, v + dv);
        if (raw == 2047) continue;
        sum += c.raw_a / (c.raw_b - raw);
        ++n;
      }
    CHECK(n > 20);
    return sum / n - p.z;
  };
  DOUBLES_EQUAL(0.0, mean_z_at(0.0, 0.0), 0.02);
  DOUBLES_EQUAL(0.0, mean_z_at(0.5, 0.5), 0.02);
  CHECK(mean_z_at(0.5, 0.0) > 0.06);  // the floor behind
}

TEST(SimSource, RefusesAnUnknownScene) {
  options.spec = "sim:attic";
  CHECK_THROWS(Failure, open_sim_source(options));
}
