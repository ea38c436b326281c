#include "tests/campaign/robot_views.hpp"

namespace st::campaign {
namespace {

sim::Scene scene_of(const std::string& name, std::uint64_t seed, bool laptop) {
  sim::SceneOptions options;
  options.name = name;
  options.seed = seed;
  options.laptop = laptop;
  return sim::make_scene(options);
}

constexpr int kMargin_px = 14;

}  // namespace

EvidenceInput RobotFrame::evidence(const Pinhole& camera) const {
  EvidenceInput in;
  in.camera = camera;
  in.roi = box.grown(kMargin_px).clipped(depth_z.width, depth_z.height);
  in.depth_m = depth_z;
  in.owners = owners;
  in.object = RobotViews::kRobot;
  in.color = color;
  return in;
}

RobotViews::RobotViews(const std::string& scene_name, std::uint64_t seed, bool laptop)
    : rig_(scene_of(scene_name, seed, laptop)) {
  const sim::Scene& s = scene();
  script_ = s.objects[0].motion;
  rig_.drive_part(s.first_robot_part, [this](double, Pose& T_room_mesh) {
    T_room_mesh = placed_;
    return true;
  });
  camera_ = Pinhole::of(s.calibration.depth);
  const Vec3 up = s.T_camera_room.R.col(2);
  support_ = make_support(up, -dot(up, s.T_camera_room.t), true);
  registration_.configure(s.calibration);
  raw_.resize(static_cast<std::size_t>(camera_.width * camera_.height));
  rgb_.resize(static_cast<std::size_t>(3 * s.calibration.color.width * s.calibration.color.height));
}

Pose RobotViews::T_room_robot(double t_s) const {
  Pose T;
  script_(t_s, T);
  return T;
}

RobotFrame RobotViews::look(const Pose& T_room_robot) {
  constexpr double kAnyTime_s = 1.0;
  constexpr std::size_t kMostPoints = 12288;  // as the loop takes them
  const sim::Scene& s = scene();
  placed_ = T_room_robot;
  rig_.depth_frame(kAnyTime_s, ++frames_, {raw_.data(), camera_.width, camera_.height});
  rig_.color_frame(kAnyTime_s, frames_, rgb_.data());

  RobotFrame frame;
  frame.T_camera_robot = s.T_camera_room * T_room_robot;
  frame.depth_z_data.assign(raw_.size(), 0.0f);
  frame.owners_data.assign(raw_.size(), 0);
  frame.color_data.assign(raw_.size(), 0);
  frame.depth_z = {frame.depth_z_data.data(), camera_.width, camera_.height};
  frame.owners = {frame.owners_data.data(), camera_.width, camera_.height};
  frame.color = {frame.color_data.data(), camera_.width, camera_.height};
  frame.box = Rect::nothing();
  const ImageView<const std::uint8_t> ids = rig_.depth().ids();
  for (int v = 0; v < camera_.height; ++v)
    for (int u = 0; u < camera_.width; ++u) {
      const std::uint16_t raw = raw_[static_cast<std::size_t>(v * camera_.width + u)];
      if (raw != sim::DepthSensor::kNoReading)
        frame.depth_z(u, v) = static_cast<float>(s.calibration.raw_a / (s.calibration.raw_b - raw));
      if (ids(u, v) != kRobot) continue;
      frame.owners(u, v) = kRobot;
      frame.box.include(u, v);
    }
  const ColorImage image{{rgb_.data(), 3 * s.calibration.color.width, s.calibration.color.height}};
  register_color(registration_, image, PoseF{}, frame.depth_z, frame.owners, kRobot, frame.box, camera_,
                 frame.color);
  const auto bind_colors = [&](Bump& memory) {
    frame.colors.bind(memory, s.calibration.color.width, s.calibration.color.height);
  };
  Bump measure;
  bind_colors(measure);
  frame.colors_data.resize(measure.used() / sizeof(std::uint64_t) + Bump::kAlign);
  Bump memory(frame.colors_data.data(), frame.colors_data.size() * sizeof(std::uint64_t));
  bind_colors(memory);
  build_color_frame(registration_, image, camera_, frame.box.grown(kMargin_px), frame.colors);
  mark_edges(frame.depth_z, kRobot, frame.box, frame.owners);
  frame.points.resize(kMostPoints);
  frame.points.resize(gather_points(frame.depth_z, frame.owners, kRobot, frame.box, camera_, frame.points));
  return frame;
}

}  // namespace st::campaign
