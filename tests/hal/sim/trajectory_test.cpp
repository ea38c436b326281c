#include "hal/sim/trajectory.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

#include "algo/core/scalar_math.hpp"

using namespace st;
using namespace st::sim;

TEST_GROUP(Trajectory){};

// A heading that passes pi must not be taken through zero between two samples.
TEST(Trajectory, TheHeadingNeverLeapsWhileTheRobotSpins) {
  constexpr double kRate_rps = 1.0, kStep_s = 0.0007;
  const Trajectory way({}, 0, 16, Moves().turn(4 * kPi, kRate_rps).done(), 0.235, {}, 1);
  for (double t = 0; t < 15; t += kStep_s) {
    const double turned = wrap_angle(way.at(t + kStep_s).yaw - way.at(t).yaw);
    CHECK(std::fabs(turned) < 1.1 * kRate_rps * kStep_s);
  }
}
