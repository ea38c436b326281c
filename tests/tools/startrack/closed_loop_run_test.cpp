// The whole closed loop with real processes, in real time: camera, tracker, guard, robot.
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/hal/create/processes.hpp"
#include "tests/sanitized.hpp"
#include "tests/support/program.hpp"

using namespace st;
using namespace st::test;

TEST_GROUP(ClosedLoopRun){};

// A robot that turns by a seventh too much on its own ends its quarter circle within three centimetres, and
// what was recorded of it replays with its wheels.
TEST(ClosedLoopRun, ARobotWithUnequalWheelsEndsWhereItsPathEnds) {
  if (kSanitized) return;
  const TempFolder folder;
  const std::string path =
      folder.file("p.toml", "speed_mps = 0.2\n[[step]]\narc = { radius_m = 0.5, angle_deg = 90 }\n");
  const Said said = startrack({"run", "--source", "sim:lab", "--robot",
                               "sim:right-scale=1.03,slip=0.02,truth=" + folder / "truth", "--loop", "closed",
                               "--path", path, "--record", folder / "rec", "--out", folder / "run"});
  CHECK_TEXT(said.code == 0 || said.code == 1, said.err.c_str());  // 1: a busy machine misses deadlines
  CHECK(content(folder / "run/events.csv").find("steering_object") != std::string::npos);
  const std::string truth = content(folder / "truth");
  const std::size_t last = truth.rfind('\n', truth.size() - 2) + 1;
  double t = 0, x = 0, y = 0, yaw = 0;
  LONGS_EQUAL(4, std::sscanf(truth.c_str() + last, "%lf,%lf,%lf,%lf", &t, &x, &y, &yaw));
  CHECK(std::hypot(x - 0.5, y - 0.5) < 0.03);
  const auto summary = nlohmann::json::parse(content(folder / "run/summary.json"));
  CHECK(summary["path"]["rmse_as_placed_m"].get<double>() < 0.03);

  const Said again = startrack({"replay", folder / "rec", "--out", folder / "again"});
  LONGS_EQUAL_TEXT(0, again.code, again.err.c_str());
  CHECK(content(folder / "rec/robot.log").find("# model create2") == 0);
}
