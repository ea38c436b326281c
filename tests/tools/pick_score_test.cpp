// tools/pick-score on runs of which it is known whom they picked.
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

TEST_GROUP(PickScore) {
  TempFolder folder;

  // The robot drives `robot_m` ahead in three seconds from a second after the pick on; what was picked goes
  // `object_m` meanwhile, in a frame of its own.
  std::string score(double robot_m, double object_m, const char* event = "steering_object") {
    std::string truth = "t,x,y,yaw\n", object = "t,state,x,y\n";
    for (int i = 0; i <= 500; ++i) {
      const double t = 10 + 0.01 * i, share = std::fmin(1, std::fmax(0, (t - 11) / 3));
      char line[96];
      std::snprintf(line, sizeof line, "%.3f,%.6f,0,0\n", t, share * robot_m);
      truth += line;
      const double seen_m = share * object_m;
      std::snprintf(line, sizeof line, "%.3f,good,%.6f,%.6f\n", t, 2 + 0.6 * seen_m, 1 - 0.8 * seen_m);
      if (i % 3 == 0) object += line;
    }
    const std::string run = folder / "run", out = folder / "out";
    std::filesystem::create_directory(run);
    folder.file("run/events.csv", std::string("t,event,object,a,b,c\n10.0,") + event + ",2,0.001,0.05,1.0\n");
    folder.file("run/object-2.csv", object);
    const std::string command = "'" STARTRACK_SOURCE_DIR "/tools/pick-score' '" + run + "' '" +
                                folder.file("truth.csv", truth) + "' > '" + out + "'";
    LONGS_EQUAL(0, std::system(command.c_str()));
    return content(out);
  }
};

TEST(PickScore, WhatGoesAsTheRobotDoesIsTheRobot) {
  STRCMP_EQUAL("right\n", score(0.4, 0.41).c_str());
  STRCMP_EQUAL("right\n", score(0.2, 0.2).c_str());  // it stopped halfway
}

// However short the drive was, and whoever it was that moved.
TEST(PickScore, AWrongPickIsSaid) {
  STRCMP_EQUAL("wrong\n", score(0.4, 0).c_str());
  STRCMP_EQUAL("wrong\n", score(0.1, 0).c_str());
  STRCMP_EQUAL("wrong\n", score(0, 0.5).c_str());
}

TEST(PickScore, WhatCannotBeToldIsNotCalledRight) {
  STRCMP_EQUAL("unclear\n", score(0.02, 0.02).c_str());
  STRCMP_EQUAL("none\n", score(0.4, 0.4, "lost").c_str());
}
