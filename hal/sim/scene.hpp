// A simulated room, what moves in it and the Kinect that looks at it. Room frame: z up, z = 0 the floor,
// metres; the (first) robot starts at the origin and looks along x, as the simulated Create's state file has
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "algo/core/calibration.hpp"
#include "algo/core/pose.hpp"
#include "hal/create/drive_base.hpp"
#include "hal/sim/depth_sensor.hpp"
#include "hal/sim/surface.hpp"
#include "hal/sim/things.hpp"

namespace st::sim {

// Forward speed and turn rate that a robot is told from t_s on; counted from the moment it starts to drive.
struct DriveCommand {
  double t_s = 0, v_mps = 0, w_rps = 0;
};

// Where a mesh is at time t_s; false: not in the room.
using Motion = std::function<bool(double t_s, Pose& T_room_mesh)>;

struct Part {
  Mesh mesh;
  Motion motion;
  int object = -1;             // index into Scene::objects, -1: nobody asks for its truth
  double shadow_radius_m = 0;  // 0: none
};

// Something whose true pose is recorded.
struct TrueObject {
  std::string label;  // of its columns in visible.csv
  Mesh mesh;          // in the frame whose pose is the truth
  Motion motion;
};

// The preset path, as the commands would drive a faultless robot from the origin.
struct PresetSample {
  double t_s = 0;
  Pose2 pose{};
  double v_mps = 0, w_rps = 0;
};

struct Scene {
  std::string name;
  std::uint64_t seed = 1;
  double duration_s = 20;
  Calibration calibration;
  Pose T_camera_room;  // depth camera, optical frame; of a camera in a hand: at time zero
  std::function<Pose(double t_s)> camera_motion;  // T_camera_room of a camera in a hand; empty: it stands
  DepthSensorOptions depth;
  double color_noise = 4, color_exposure = 1, color_drift = 0.05;
  double host_jitter_s = 0.004;
  std::vector<Vec3> lamps_room;
  Mesh still;  // the room, room frame
  std::vector<Part> parts;
  std::vector<TrueObject> objects;
  std::vector<PresetSample> preset;  // from the moment the robot starts
  double start_s = 0;                // when the first robot starts to drive
  int first_robot_part = -1;         // the part that a simulated Create drives in a live run

  Pose camera_at(double t_s) const { return camera_motion ? camera_motion(t_s) : T_camera_room; }
};

struct SceneOptions {
  std::string name = "lab";
  std::uint64_t seed = 1;
  RobotModel robot = RobotModel::kCreate2;
  bool laptop = false;
  ThingSpec thing;                 // of scene `thing`
  double seconds = 0;              // 0: as long as the scene's script
  double bow_steps = 0;            // smooth depth error over the image, peak, raw steps; 0: the seed's own
  std::vector<DriveCommand> path;  // replaces the scene's own path of the first robot; empty: its own
};

// Names in the order of the help text.
std::span<const char* const> scene_names();

// Throws Failure (kBadInput) for a name that is none.
Scene make_scene(const SceneOptions& options);

}  // namespace st::sim
