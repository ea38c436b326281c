// A depth sensor's own error, from floors. A plane is linear in disparity over the image, whatever the
// sensor's two constants are, so what is left of a plane's fit is the sensor's: a smooth error over the image
// (Kinects bow a plane by up to some steps, that is by centimetres at 3 m). What is itself linear over the
// image cannot be told from a tilt of the floor and stays with it.
#pragma once

#include <vector>

#include "tools/calibrate/floor_view.hpp"

namespace st {

// A floor's disparity over the image, codes: a x + b y + c at the pixel whose ray is (x, y, 1).
struct FloorCodes {
  double a = 0, b = 0, c = 0;
};

using FloorSamples = std::vector<FloorSample>;

struct DepthFit {
  DisparityCorrection correction;
  std::vector<FloorCodes> floors;  // of each view, once corrected
  // Error that is smooth over patches of the floor, RMS in raw steps, without and with a correction. Measured
  // on every second patch, which took no part in that fit; the one above is of all.
  double before_steps = 0, after_steps = 0;
  double largest_steps = 0;  // of the correction, where floor was seen
  double seen_share = 0;     // of the image

  // Less than a tenth is gained where there is no bow but the noise of single patches.
  bool worth_it() const { return after_steps < 0.9 * before_steps; }
};

// One set of normal equations for all planes and all nodes: samples with the rounding error of a step, and
// nodes that hang together (second differences) and stay small where nothing was seen. `views`: samples of
// each recording, at least one with some.
DepthFit fit_depth(const Calibration& calibration, const std::vector<FloorSamples>& views);

// Where a floor lies: the camera's height above it, and the direction up, camera frame.
struct FloorPlane {
  double height_m = 0;
  Vec3 up;
};
FloorPlane plane_of(const Calibration& calibration, const FloorCodes& floor);

// raw_b, so that every floor lies as far below the camera as a tape says. A step of it moves a floor at
// height h by h^2 up_z / raw_a only: the steeper the camera looks down, the better.
struct HeightFit {
  double raw_b = 0;
  double sigma_steps = 0;  // of raw_b, when a tape is right within 3 mm
};
HeightFit fit_heights(const Calibration& calibration, const std::vector<FloorCodes>& floors,
                      const std::vector<double>& heights_m);

}  // namespace st
