// The bodies that drive. Base frame: origin on the floor under the axle, x forward, y left, z up.
#pragma once

#include "hal/create/drive_base.hpp"
#include "hal/sim/surface.hpp"

namespace st::sim {

struct RobotShape {
  Mesh mesh;
  double wheel_base_m = 0.235;
  double radius_m = 0.165;
  double height_m = 0.09;
};

// Create 1: open cargo bay behind the axle, button panel before it, dark bumper round the front.
// Create 2: closed flat top with faceplate, IR dome, bumper standing off in front.
// `with_laptop`: an open notebook lies on top.
RobotShape make_robot(RobotModel model, bool with_laptop);

}  // namespace st::sim
