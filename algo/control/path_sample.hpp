// The preset path at one instant, in the frame of the path's start (x forward, y left), or laid on the floor.
#pragma once

namespace st {

struct PathSample {
  double t_s = 0;
  double x_m = 0, y_m = 0, yaw_rad = 0;  // yaw unwrapped
  double v_mps = 0, w_rps = 0;
};

}  // namespace st
