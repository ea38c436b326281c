// The simulated Kinect in its scene: frames at any time of the scene's clock.
#pragma once

#include <memory>
#include <vector>

#include "hal/sim/color_sensor.hpp"
#include "hal/sim/depth_sensor.hpp"
#include "hal/sim/scene.hpp"

namespace st::sim {

// What a depth frame truly showed of one object.
struct Visibility {
  int pixels = 0;        // that show it
  int whole_pixels = 0;  // that would if nothing stood before it
  int valid = 0;         // of `pixels`, with a reading
};

class CameraRig {
 public:
  // Draws the still room: a second or so.
  explicit CameraRig(Scene scene);

  const Scene& scene() const { return scene_; }
  // Lets somebody else drive the part: a simulated Create.
  void drive_part(int part, Motion motion);

  // The depth frame of time t_s; `index` numbers the frames and seeds their noise. raw: width x height.
  void depth_frame(double t_s, std::uint64_t index, ImageView<std::uint16_t> raw);
  // The colour frame of time t_s: RGB, 3 x width x height bytes.
  void color_frame(double t_s, std::uint64_t index, std::uint8_t* rgb);

  // Of the depth frame last made, with its raw values.
  std::vector<Visibility> visibility(ImageView<const std::uint16_t> raw) const;
  const DepthSensor& depth() const { return *depth_; }

 private:
  Pose color_room_at(double t_s) const { return scene_.calibration.T_color_depth * scene_.camera_at(t_s); }
  std::vector<Vec3f> lamps_at(const Pose& T_color_room) const;

  Scene scene_;
  std::unique_ptr<DepthSensor> depth_;
  std::unique_ptr<ColorSensor> color_;
};

}  // namespace st::sim
