// tools/path-score against ways whose distance from the path is known.
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/program.hpp"
#include "tests/support/temp_folder.hpp"

using namespace st;
using namespace st::test;

namespace {

struct Score {
  double rmse_mm = -1, max_mm = -1, end_mm = -1;
};

}  // namespace

TEST_GROUP(PathScore) {
  TempFolder folder;
  std::string path = "t,x,y,yaw,v,w\n", truth = "t,x,y,yaw\n";
  double t = 10;

  static void row(std::string & csv, double t_s, double x, double y, const char* rest) {
    char line[96];
    std::snprintf(line, sizeof line, "%.3f,%.6f,%.6f,%s\n", t_s, x, y, rest);
    csv += line;
  }
  void prescribe(double x, double y) { row(path, t += 0.01, x, y, "0,0.2,0"); }
  void drive(double x, double y) { row(truth, t += 0.01, x, y, "0"); }

  Score score(const std::string& radius = {}) {
    const std::string run = folder / "run", out = folder / "out";
    std::filesystem::create_directory(run);
    if (radius.empty()) folder.file("run/path.csv", path);
    folder.file("run/events.csv", "t,event,object,a,b,c\n");
    const std::string command = "'" STARTRACK_SOURCE_DIR "/tools/path-score' '" + run + "' '" +
                                folder.file("truth.csv", truth) + "' " + radius + " > '" + out + "'";
    LONGS_EQUAL(0, std::system(command.c_str()));
    Score s;
    LONGS_EQUAL(3, std::sscanf(content(out).c_str(), "%lf %lf %lf", &s.rmse_mm, &s.max_mm, &s.end_mm));
    return s;
  }
};

// A metre ahead; driven to 50 mm beyond its end.
TEST(PathScore, WayBeyondTheEndOfThePathIsAnError) {
  for (int i = 0; i <= 100; ++i) prescribe(0.01 * i, 0);
  for (int i = 0; i <= 105; ++i) drive(0.01 * i, 0);
  const Score s = score();
  DOUBLES_EQUAL(50, s.end_mm, 0.1);
  DOUBLES_EQUAL(40, s.max_mm, 10.1);  // of where it still moved
  CHECK(s.max_mm > 39);
}

// A corner to the left, driven 60 mm too far before the turn.
TEST(PathScore, ACornerThatIsOvershotIsAnError) {
  for (int i = 0; i <= 50; ++i) prescribe(0.01 * i, 0);
  for (int i = 0; i <= 50; ++i) prescribe(0.5, 0.01 * i);
  for (int i = 0; i <= 56; ++i) drive(0.01 * i, 0);
  for (int i = 0; i <= 50; ++i) drive(0.56, 0.01 * i);
  const Score s = score();
  DOUBLES_EQUAL(60, s.max_mm, 0.1);
  DOUBLES_EQUAL(60, s.end_mm, 0.1);
}

TEST(PathScore, ACircleNeedsNoPathFile) {
  for (int i = 0; i <= 628; ++i) drive(0.52 * std::sin(0.01 * i), 0.52 * (1 - std::cos(0.01 * i)));
  const Score s = score("0.5");
  DOUBLES_EQUAL(40, s.max_mm, 0.2);  // at the far side
  CHECK(s.rmse_mm > 20 && s.rmse_mm < 30);
}
