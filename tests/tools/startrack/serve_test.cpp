// A student's program, and the robot that it leaves alone. In real time, with real processes.
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <cstdio>

#include "tests/hal/create/processes.hpp"
#include "tests/sanitized.hpp"
#include "tests/support/program.hpp"

using namespace st;
using namespace st::test;

namespace {

struct TruePose {
  double t = 0, x = 0, y = 0, yaw = 0;
};

std::vector<TruePose> truth_of(const std::string& file) {
  std::vector<TruePose> poses;
  std::ifstream lines(file);
  std::string line;
  while (std::getline(lines, line)) {
    TruePose p;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &p.t, &p.x, &p.y, &p.yaw) == 4) poses.push_back(p);
  }
  return poses;
}

double moved_m(const TruePose& a, const TruePose& b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

TEST_GROUP(Serve){};

TEST(Serve, ARobotWhoseProgramIsKilledStands) {
  if (kSanitized) return;
  const TempFolder folder;
  Running run({"run", "--source", "sim:lab", "--robot", "sim:truth=" + folder / "truth", "--serve", "0",
               "--out", folder / "run"},
              folder.path());
  int port = 0;
  for (int i = 0; i < 1000 && port == 0; ++i, sleep_ms(10))
    std::sscanf(content(folder / "stdout").c_str(), "serve: port %d", &port);
  CHECK(port > 0);
  const pid_t student = fork();
  if (student == 0) {
    execlp("python3", "python3", STARTRACK_SOURCE_DIR "/tools/client/hold_circle.py",
           std::to_string(port).c_str(), "100", static_cast<char*>(nullptr));
    _exit(127);
  }
  bool drives = false;
  for (int i = 0; i < 600 && !drives; ++i) {  // half a metre from where it began: no start motion goes so far
    sleep_ms(50);
    const auto poses = truth_of(folder / "truth");
    drives = poses.size() > 1 && moved_m(poses.front(), poses.back()) > 0.5;
  }
  kill(student, SIGKILL);
  wait_for_exit(student, 2000);
  CHECK(drives);
  sleep_ms(1000);
  const auto at_rest = truth_of(folder / "truth").back();
  sleep_ms(1000);
  const auto later = truth_of(folder / "truth").back();
  CHECK(later.t > at_rest.t + 0.5);  // it still runs, and stands
  DOUBLES_EQUAL(0, moved_m(at_rest, later), 1e-3);
  run.send(SIGINT);
  LONGS_EQUAL(130, run.wait().code);
  CHECK(content(folder / "run/events.csv").find("steering_object") != std::string::npos);
}
