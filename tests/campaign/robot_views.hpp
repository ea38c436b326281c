// A simulated robot as the loop would see it, put wherever one likes: its depth, its pixels, their colours,
// its points, and the true pose.
#pragma once

#include <string>
#include <vector>

#include "algo/core/pinhole.hpp"
#include "algo/tracking/observe.hpp"
#include "algo/tracking/track.hpp"
#include "algo/volume/integrate.hpp"
#include "hal/sim/camera_rig.hpp"

namespace st::campaign {

struct RobotFrame {
  Pose T_camera_robot;  // true; robot: base frame, origin on the floor under the axle
  std::vector<float> depth_z_data;
  std::vector<std::uint8_t> owners_data;
  std::vector<std::uint32_t> color_data;
  ImageView<float> depth_z;
  ImageView<std::uint8_t> owners;  // 1: the robot, kEdge: near its outline, 0: behind it
  ImageView<std::uint32_t> color;
  Rect box;
  std::vector<ObservedPoint> points;
  ColorFrame colors;
  std::vector<std::uint64_t> colors_data;

  EvidenceInput evidence(const Pinhole& camera) const;
};

class RobotViews {
 public:
  static constexpr std::uint8_t kRobot = 1;

  RobotViews(const std::string& scene, std::uint64_t seed, bool laptop);

  const Pinhole& camera() const { return camera_; }
  const sim::Scene& scene() const { return rig_.scene(); }
  const Support& support() const { return support_; }  // the true floor

  // Where the scene's script has the robot.
  Pose T_room_robot(double t_s) const;
  // A frame with the robot standing there, colours taken at the same instant.
  RobotFrame look(const Pose& T_room_robot);

 private:
  sim::CameraRig rig_;
  sim::Motion script_;
  Pose placed_;
  Pinhole camera_;
  Support support_;
  ColorRegistration registration_;
  std::uint64_t frames_ = 0;
  std::vector<std::uint16_t> raw_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace st::campaign
