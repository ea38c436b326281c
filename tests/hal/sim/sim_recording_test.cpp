#include "hal/sim/sim_recording.hpp"

#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "algo/core/scalar_math.hpp"
#include "tests/support/temp_folder.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::sim;
namespace fs = std::filesystem;

namespace {

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

std::vector<std::string> lines(const fs::path& path) {
  std::ifstream in(path);
  std::vector<std::string> all;
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

int simulate(const std::string& arguments) {
  const std::string command = std::string(STARTRACK_BINARY) + " simulate " + arguments + " >/dev/null 2>&1";
  return WEXITSTATUS(std::system(command.c_str()));
}

}  // namespace

TEST_GROUP(SimRecording) {
  TempFolder temporary;
  const fs::path folder = temporary.path();

  void record(const char* scene, std::uint64_t seed, const fs::path& into, double seconds = 0.6) {
    SceneOptions o;
    o.name = scene;
    o.seed = seed;
    o.seconds = seconds;
    CameraRig rig(make_scene(o));
    fs::create_directories(into);
    const std::atomic<bool> stop{false};
    write_recording(rig, into.string(), stop, [](std::uint64_t, std::uint64_t) {});
  }
};

TEST(SimRecording, WritesWhatFakenectRecordWrites) {
  record("circle", 3, folder);  // seed 3: the counter wraps within seconds
  double host_before = 0;
  int depth = 0, color = 0, tilt = 0;
  for (const std::string& line : lines(folder / "INDEX.txt")) {
    char type = 0, extension[8] = "";
    double host = 0;
    unsigned ticks = 0;
    LONGS_EQUAL(4, std::sscanf(line.c_str(), "%c-%lf-%u.%7s", &type, &host, &ticks, extension));
    CHECK(host >= host_before);
    host_before = host;
    const std::string data = contents(folder / line);
    if (type == 'd') {
      ++depth;
      CHECK(data.starts_with("P5 640 480 65535\n"));
      UNSIGNED_LONGS_EQUAL(17 + 2 * 640 * 480, data.size());
    } else if (type == 'r') {
      ++color;
      CHECK(data.starts_with("P6 640 480 255\n"));
      UNSIGNED_LONGS_EQUAL(15 + 3 * 640 * 480, data.size());
    } else {
      ++tilt;
      UNSIGNED_LONGS_EQUAL(12, data.size());
    }
  }
  LONGS_EQUAL(17, depth);
  LONGS_EQUAL(depth, tilt);
  CHECK(color >= depth - 1);
  CHECK(fs::exists(folder / "camera.toml"));
  CHECK(contents(folder / "truth.ply").starts_with("ply\nformat binary_little_endian"));
  STRCMP_EQUAL("t,x,y,yaw,v,w", lines(folder / "path.csv").at(0).c_str());
}

TEST(SimRecording, TruthHasALineForEveryDepthFrameAtItsStamp) {
  record("circle", 2, folder);
  const auto truth = lines(folder / "truth.tum"), visible = lines(folder / "visible.csv");
  STRCMP_EQUAL("host_t,clk_t,tick,frame,robot_px,robot_frac,robot_valid,valid_frac", visible.at(0).c_str());
  UNSIGNED_LONGS_EQUAL(truth.size() + 1, visible.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    double t = 0, x, y, z, qx, qy, qz, qw, host, clock, share, valid_share;
    unsigned ticks = 0;
    int frame = 0, pixels = 0, valid = 0;
    LONGS_EQUAL(8, std::sscanf(truth[i].c_str(), "%lf %lf %lf %lf %lf %lf %lf %lf", &t, &x, &y, &z, &qx, &qy,
                               &qz, &qw));
    LONGS_EQUAL(8, std::sscanf(visible[i + 1].c_str(), "%lf,%lf,%u,%d,%d,%lf,%d,%lf", &host, &clock, &ticks,
                               &frame, &pixels, &share, &valid, &valid_share));
    DOUBLES_EQUAL(t, host, 1e-9);
    LONGS_EQUAL(static_cast<long>(i), frame);
    DOUBLES_EQUAL(ticks / 60e6, std::fmod(clock, 4294967296.0 / 60e6), 1e-5);
    CHECK(pixels > 2000 && valid <= pixels && valid > pixels / 2);
    DOUBLES_EQUAL(1.0, share, 0.02);
    CHECK(valid_share > 0.5 && valid_share <= 1.0);
    DOUBLES_EQUAL(1.0, qx * qx + qy * qy + qz * qz + qw * qw, 1e-5);
  }
}

TEST(SimRecording, TheSameSeedGivesTheSameBytes) {
  record("walking-legs", 5, folder / "a", 0.4);
  record("walking-legs", 5, folder / "b", 0.4);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder / "a")) {
    CHECK(contents(entry.path()) == contents(folder / "b" / entry.path().filename()));
    ++files;
  }
  CHECK(files > 30);
}

TEST(SimRecording, SeveralRobotsHaveATruthEach) {
  record("two-robots", 1, folder, 0.3);
  CHECK(fs::exists(folder / "truth-1.tum") && fs::exists(folder / "truth-2.tum") &&
        !fs::exists(folder / "truth.tum"));
  CHECK(fs::exists(folder / "truth-1.ply") && fs::exists(folder / "truth-2.ply"));
  STRCMP_EQUAL("host_t,clk_t,tick,frame,1_px,1_frac,1_valid,2_px,2_frac,2_valid,valid_frac",
               lines(folder / "visible.csv").at(0).c_str());
}

TEST(SimRecording, StoppingLeavesWholeFiles) {
  SceneOptions o;
  CameraRig rig(make_scene(o));
  std::atomic<bool> stop{false};
  const std::uint64_t written = write_recording(rig, folder.string(), stop,
                                                [&](std::uint64_t done, std::uint64_t) { stop = done >= 4; });
  UNSIGNED_LONGS_EQUAL(4, written);
  UNSIGNED_LONGS_EQUAL(4, lines(folder / "truth.tum").size());
  UNSIGNED_LONGS_EQUAL(5, lines(folder / "visible.csv").size());
}

TEST(SimRecording, CommandRefusesAFullFolderUnlessForcedAndThenSparesWhatIsNotItsOwn) {
  const std::string out = " --out " + (folder / "r").string() + " --seconds 0.2";
  LONGS_EQUAL(0, simulate("circle" + out));
  LONGS_EQUAL(2, simulate("circle" + out));
  std::ofstream(folder / "r" / "notes.txt") << "mine";
  std::ofstream(folder / "r" / "d-1.000000-1.pgm") << "old";
  LONGS_EQUAL(0, simulate("circle --force" + out));
  CHECK(fs::exists(folder / "r" / "notes.txt"));
  CHECK(!fs::exists(folder / "r" / "d-1.000000-1.pgm"));
  LONGS_EQUAL(2, simulate("nowhere --out " + (folder / "s").string()));
  LONGS_EQUAL(2, simulate("circle --robot-model create3 --out " + (folder / "s").string()));
}

TEST(SimRecording, APathFileIsDrivenInTheLab) {
  {
    std::ofstream path(folder / "line.toml");
    path << "speed_mps = 0.2\n[[step]]\nline = 0.4\n";
  }
  LONGS_EQUAL(0, simulate("lab --path " + (folder / "line.toml").string() + " --seconds 4.5 --out " +
                          (folder / "r").string()));
  const auto truth = lines(folder / "r" / "truth.tum");
  double a[4], b[4];
  LONGS_EQUAL(4, std::sscanf(truth.front().c_str(), "%lf %lf %lf %lf", &a[0], &a[1], &a[2], &a[3]));
  LONGS_EQUAL(4, std::sscanf(truth.back().c_str(), "%lf %lf %lf %lf", &b[0], &b[1], &b[2], &b[3]));
  DOUBLES_EQUAL(0.4,
                std::sqrt((a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]) +
                          (a[3] - b[3]) * (a[3] - b[3])),
                0.03);
}

TEST(SimRecording, AHandHeldCameraHasItsWayForTruthAndItsPushesInTheAccelerometer) {
  const fs::path into = folder / "scan";
  record("scan", 3, into, 1.0);
  const std::vector<std::string> poses = lines(into / "truth.tum");
  UNSIGNED_LONGS_EQUAL(29, poses.size());
  double before[3] = {0, 0, 0}, way_m = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    double t = 0, at[3];
    LONGS_EQUAL(4, std::sscanf(poses[i].c_str(), "%lf %lf %lf %lf", &t, &at[0], &at[1], &at[2]));
    const double step = std::hypot(at[0] - before[0], at[1] - before[1], at[2] - before[2]);
    if (i > 0) CHECK(step < 0.03);
    if (i > 0) way_m += step;
    for (int a = 0; a < 3; ++a) before[a] = at[a];
  }
  CHECK(way_m > 0.1 && way_m < 0.5);
  CHECK(fs::file_size(into / "truth.ply") > 10000);  // the room

  SceneOptions o;
  o.name = "scan";
  o.seed = 3;
  const Scene scene = make_scene(o);
  const Vec3 now = gravity_reading(scene, 0.3), later = gravity_reading(scene, 0.4);
  DOUBLES_EQUAL(9.8, norm(now), 1.5);
  CHECK(norm(now - later) > 0.05);
}
