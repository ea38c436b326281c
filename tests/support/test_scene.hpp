// An analytic scene for tests: a floor (or a wall) and boxes, seen by a Kinect with its steps, noise and
// projector shadow. Shares nothing with the code under test but the calibration struct.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/core/calibration.hpp"

namespace st::test {

// Floor frame: z up, origin on the floor below the camera, y ahead of the camera.
struct SceneBox {
  double x = 0, y = 2, z = 0;  // centre of its bottom face
  double width = 0.34, depth = 0.34, height = 0.09, yaw = 0;
  bool operator==(const SceneBox&) const = default;
};

struct TestScene {
  double camera_height = 1.2;
  double pitch_rad = 0.55;  // looking down
  bool floor = true;
  double wall_y = 6;  // a wall ahead, perpendicular to y
  std::vector<SceneBox> boxes = {};
  double noise_raw = 0.5;  // standard deviation, raw steps
  bool operator==(const TestScene&) const = default;
};

struct RenderedScene {
  std::vector<std::uint16_t> raw;  // 2047: no reading
  std::vector<std::uint8_t> mask;  // 0 floor, wall or nothing, else box number + 1, shadow and noise aside
};

// The Kinect's model at a size of 640x480 or smaller.
Calibration kinect_calibration(int width, int height);

class SceneCamera {
 public:
  explicit SceneCamera(const Calibration& calibration) : calibration_(calibration) {}
  const Calibration& calibration() const { return calibration_; }
  // The next frame: the geometry is computed anew only when the scene is another one, the noise always.
  const RenderedScene& render(const TestScene& scene);

 private:
  void trace(const TestScene& scene);

  Calibration calibration_;
  TestScene scene_;
  std::vector<double> disparity_;  // raw, exact; negative where there is no reading
  RenderedScene out_;
  std::uint32_t random_ = 77;
};

}  // namespace st::test
