#include "hal/sim/room.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "hal/sim/furniture.hpp"
#include "hal/sim/mesh_builder.hpp"

namespace st::sim {
namespace {

// Camera at (x, 0, height) of the stage, looking along +x and down by `pitch`, turned by `roll` about its
// axis.
Pose camera_on_stage(double x_m, double height_m, double pitch_rad, double roll_rad) {
  const SinCos p = sin_cos(pitch_rad);
  const Vec3 forward{p.cos, 0, -p.sin}, right{0, -1, 0};
  const Mat3 R_stage_camera =
      Mat3::from_columns(right, cross(forward, right), forward) * rotation_z(roll_rad);
  return Pose{R_stage_camera, {x_m, 0, height_m}}.inverse();
}

// All of a robot of 0.19 m radius and 0.1 m height at each place, with room for its shadow at the left.
bool all_in_view(const Intrinsics& k, const Pose& T_camera_stage, const std::vector<Vec3>& places) {
  for (const Vec3& place : places)
    for (int i = 0; i < 16; ++i) {
      const SinCos sc = sin_cos(i * kPi / 4);
      const Vec3 p =
          T_camera_stage * Vec3{place.x + 0.19 * sc.cos, place.y + 0.19 * sc.sin, i < 8 ? 0.0 : 0.1};
      if (p.z < 0.7) return false;
      const double u = k.fx * p.x / p.z + k.cx, v = k.fy * p.y / p.z + k.cy;
      if (u < 40 || u > k.width - 28 || v < 18 || v > k.height - 18) return false;
    }
  return true;
}

Pose upright(double x, double y, double yaw, double z = 0) { return {rotation_z(yaw), {x, y, z}}; }

}  // namespace

void add_still(Scene& scene, const Mesh& mesh, const Pose& T_room_mesh) {
  MeshBuilder all;
  all.append(scene.still, Pose{});
  all.append(mesh, T_room_mesh);
  scene.still = all.take();
}

void choose_sensor(Scene& scene, Random& random) {
  Intrinsics& depth = scene.calibration.depth;
  // To a tenth of a pixel, so that what camera.toml prints is what was used.
  const auto near = [&](double middle, double spread, double unit) {
    return std::round((middle + random.uniform(-spread, spread)) / unit) * unit;
  };
  depth.fx = depth.fy = near(575.8, 7, 0.1);
  depth.cx = near(320, 6, 0.1);
  depth.cy = near(240, 6, 0.1);
  scene.calibration.raw_b = near(1089.4, 4, 0.001);
  scene.calibration.raw_a = std::round(8 * depth.fx * scene.depth.baseline_m * 1e4) / 1e4;
  scene.calibration.has_color = true;
  Intrinsics& color = scene.calibration.color;
  color.fx = color.fy = near(525, 5, 0.1);
  color.cx = near(319.5, 5, 0.1);
  color.cy = near(239.5, 5, 0.1);
  scene.calibration.T_color_depth = {
      rotation_from_vector({near(0, 0.004, 1e-6), near(0, 0.004, 1e-6), near(0, 0.004, 1e-6)}),
      {near(-0.025, 0.001, 1e-6), near(0, 0.0005, 1e-6), near(0, 0.001, 1e-6)}};
  DepthSensorOptions& d = scene.depth;
  d.camera = {static_cast<float>(depth.fx),
              static_cast<float>(depth.fy),
              static_cast<float>(depth.cx),
              static_cast<float>(depth.cy),
              depth.width,
              depth.height};
  d.raw_a = scene.calibration.raw_a;
  d.raw_b = scene.calibration.raw_b;
  d.frozen_noise = random.uniform(0.38, 0.52);
  d.flicker_noise = random.uniform(0.12, 0.20);
  d.bias = random.uniform(0.1, 0.35);
  d.seed = scene.seed;
  scene.color_noise = random.uniform(2.5, 6);
  scene.color_exposure = random.uniform(0.85, 1.2);
  scene.color_drift = random.uniform(0.02, 0.08);
  scene.host_jitter_s = random.uniform(0.002, 0.006);
}

Stage place_camera(Scene& scene, const std::vector<Pose2>& places, double azimuth_rad, double height_m,
                   Random& random) {
  Stage stage;
  const SinCos a = sin_cos(azimuth_rad);
  double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
  for (const Pose2& p : places) {
    const double x = p.x * a.cos + p.y * a.sin, y = -p.x * a.sin + p.y * a.cos;
    low_x = std::min(low_x, x);
    high_x = std::max(high_x, x);
    low_y = std::min(low_y, y);
    high_y = std::max(high_y, y);
  }
  const double mid_x = 0.5 * (low_x + high_x), mid_y = 0.5 * (low_y + high_y);
  stage.T_room_stage = {rotation_z(azimuth_rad),
                        {mid_x * a.cos - mid_y * a.sin, mid_x * a.sin + mid_y * a.cos, 0}};
  stage.near_m = low_x - mid_x;
  stage.far_m = high_x - mid_x;
  stage.half_width_m = 0.5 * (high_y - low_y);
  std::vector<Vec3> seen;
  for (std::size_t i = 0; i < places.size(); i += std::max<std::size_t>(1, places.size() / 60))
    seen.push_back(stage.T_room_stage.inverse() * Vec3{places[i].x, places[i].y, 0});
  const double roll = random.uniform(-0.02, 0.02);
  stage.camera_height_m = height_m;
  const auto pose_at = [&](double distance, double pitch) {
    return camera_on_stage(-distance, height_m, pitch, roll);
  };
  double distance = 0.9, pitch = 0;
  for (bool fits = false; !fits && distance < 4.0; distance += 0.02) {
    const double steep = arc_tan2(height_m, distance + stage.near_m - 0.19);
    const double flat = arc_tan2(height_m - 0.1, distance + stage.far_m + 0.19);
    pitch = 0.5 * (steep + flat);
    fits = all_in_view(scene.calibration.depth, pose_at(distance, pitch), seen);
  }
  // People step back a little and tip the camera up as far as the robot's place allows: the room comes into
  // view.
  distance += random.uniform(0.1, 0.3);
  const double steepest = pitch + 0.1;
  pitch -= random.uniform(0.15, 0.35);
  while (pitch < steepest && !all_in_view(scene.calibration.depth, pose_at(distance, pitch), seen))
    pitch += 0.005;
  stage.camera_x_m = -distance;
  const Pose T_camera_stage = pose_at(distance, pitch);
  scene.T_camera_room = T_camera_stage * stage.T_room_stage.inverse();
  return stage;
}

namespace {

struct Walls {
  Pose T_room_walls;  // the room is a little askew to the camera
  double back_x_m, half_m, camera_side_x_m;
  double desk_y_m;
};

void add_walls(Scene& scene, const Walls& w, Random& random) {
  const auto f = [](double x) { return static_cast<float>(x); };
  const float x0 = f(w.camera_side_x_m), x1 = f(w.back_x_m), y = f(w.half_m);
  MeshBuilder room;
  const std::uint32_t floor = room.material(floor_material(static_cast<FloorKind>(random.below(4)), random));
  const std::uint32_t wall = room.material(wall_material(random));
  const std::uint32_t skirting = room.material(Paint{0.25f, 0.23f, 0.22f, 0.35f});
  room.grid({x0, -y, 0}, {x1 - x0, 0, 0}, {0, 2 * y, 0}, 0.4f, floor);
  room.grid({x1, y, 0}, {0, -2 * y, 0}, {0, 0, 2.6f}, 0.4f, wall);
  room.grid({x0, y, 0}, {x1 - x0, 0, 0}, {0, 0, 2.6f}, 0.4f, wall);
  room.grid({x1, -y, 0}, {x0 - x1, 0, 0}, {0, 0, 2.6f}, 0.4f, wall);
  room.box({x1 - 0.012f, -y, 0}, {x1, y, 0.08f}, skirting);
  add_still(scene, room.take(), w.T_room_walls);
  add_still(scene, make_desk(random), w.T_room_walls * upright(w.back_x_m - 0.45, w.desk_y_m, 0));
  add_still(scene, make_poster(random),
            w.T_room_walls * upright(w.back_x_m - 0.01, w.desk_y_m + random.uniform(-1.2, 1.2), 0, 1.3));
}

// Looks for places behind or beside what must be seen, apart from one another.
class FreePlaces {
 public:
  FreePlaces(const Stage& stage, const Walls& walls, const std::vector<Pose2>& robots)
      : stage_(stage), walls_(walls), robots_(robots), T_walls_room_(walls.T_room_walls.inverse()) {}

  // False when thirty tries found none.
  bool find(double clearance_m, Random& random, double* x, double* y) {
    for (int attempt = 0; attempt < 30; ++attempt) {
      *x = random.uniform(stage_.near_m, walls_.back_x_m - 0.35);
      *y = random.uniform(-walls_.half_m + 0.3, walls_.half_m - 0.3);
      if (!in_view_but_not_in_the_way(*x, *y, clearance_m) || !apart(*x, *y, clearance_m)) continue;
      taken_.push_back({*x, *y, 0});
      return true;
    }
    return false;
  }

 private:
  bool in_view_but_not_in_the_way(double x, double y, double clearance_m) const {
    const bool in_view = std::fabs(y) < 0.5 * (x - stage_.camera_x_m) + 0.1;
    const bool aside =
        x > stage_.far_m + 0.25 + clearance_m || std::fabs(y) > stage_.half_width_m + 0.3 + clearance_m;
    const bool at_desk = x > walls_.back_x_m - 0.8 && std::fabs(y - walls_.desk_y_m) < 0.95;
    return in_view && aside && !at_desk;
  }
  bool apart(double x, double y, double clearance_m) const {
    for (const Pose2& other : taken_)
      if (std::fabs(other.x - x) + std::fabs(other.y - y) < 0.75) return false;
    for (std::size_t i = 0; i < robots_.size(); i += 4) {
      const Vec3 p = T_walls_room_ * Vec3{robots_[i].x, robots_[i].y, 0};
      if (norm(Vec3{p.x - x, p.y - y, 0}) < 0.25 + clearance_m) return false;
    }
    return true;
  }

  const Stage& stage_;
  const Walls& walls_;
  const std::vector<Pose2>& robots_;
  Pose T_walls_room_;
  std::vector<Pose2> taken_;
};

}  // namespace

void furnish(Scene& scene, const Stage& stage, const std::vector<Pose2>& places, bool with_chair,
             Random& random) {
  Walls walls{};
  walls.back_x_m = stage.far_m + random.uniform(1.5, 2.4);
  walls.half_m = std::max(2.3, stage.half_width_m + random.uniform(1.2, 2.0));
  walls.camera_side_x_m = stage.camera_x_m - 0.6;
  walls.T_room_walls = stage.T_room_stage * upright(0, 0, random.uniform(-0.15, 0.15));
  walls.desk_y_m = random.uniform(-0.9, 0.9);
  add_walls(scene, walls, random);
  FreePlaces free_places(stage, walls, places);
  double x = 0, y = 0;
  if (with_chair && free_places.find(0.3, random, &x, &y))
    add_still(scene, make_chair(random), walls.T_room_walls * upright(x, y, random.uniform(-kPi, kPi)));
  const int boxes = 2 + random.below(3);
  for (int i = 0; i < boxes; ++i)
    if (free_places.find(0.25, random, &x, &y)) {
      const auto side = static_cast<float>(random.uniform(0.2, 0.45));
      const auto tall = static_cast<float>(random.uniform(0.15, 0.5));
      const auto other_side = side * static_cast<float>(random.uniform(0.6, 1.2));
      add_still(scene, make_cardboard_box(side, other_side, tall, random),
                walls.T_room_walls * upright(x, y, random.uniform(-kPi, kPi)));
    }
  for (const double side : {-1.0, 1.0}) {
    const double ahead = random.uniform(-1, 0.5), aside = side * random.uniform(0.5, 1.4);
    scene.lamps_room.push_back(stage.T_room_stage * Vec3{ahead, aside, random.uniform(2.3, 2.8)});
  }
}

}  // namespace st::sim
