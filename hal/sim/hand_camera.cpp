#include "hal/sim/hand_camera.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "hal/sim/furniture.hpp"
#include "hal/sim/robots.hpp"
#include "hal/sim/room.hpp"

namespace st::sim {
namespace {

// 0 before `from`, 1 after `to`, without a jerk between.
double ease(double t, double from, double to) {
  const double x = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return x * x * x * (x * (6 * x - 15) + 10);
}

// Turned away between `from` and `to`, by turns that take `turn_s` each.
double away(double t, double from, double to, double turn_s) {
  return ease(t, from, from + turn_s) * (1 - ease(t, to - turn_s, to));
}

// What the hand does besides what it wants to.
struct Tremor {
  double phase[6];
  explicit Tremor(Random& random) {
    for (double& p : phase) p = random.uniform(0, 2 * kPi);
  }
  // Sum of a sway, an unsteadiness and a tremble, each axis by itself.
  double at(double t, int axis) const {
    constexpr double kRate_hz[3] = {0.9, 2.6, 7.0}, kShare[3] = {1, 0.35, 0.08};
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      sum += kShare[i] * sin_cos(2 * kPi * kRate_hz[i] * (1 + 0.07 * axis) * t + (i + 1) * phase[axis]).sin;
    return sum;
  }
};

struct Way {
  double azimuth_rad, sweep_rad;  // middle of the arc and how far it goes to either side
  double radius_m, height_m;
  double period_s;  // there and back
  double tremor_m, tremor_rad;
  double look_up_rad = 0, look_aside_rad = 0, come_close_m = 0;  // while turned away
  double away_from_s = 1e9, away_to_s = 1e9, turn_s = 1;
};

Pose camera_at(const Way& w, const Tremor& tremor, double t) {
  const SinCos phase = sin_cos(2 * kPi * t / w.period_s), twice = sin_cos(4 * kPi * t / w.period_s);
  const double off = away(t, w.away_from_s, w.away_to_s, w.turn_s);
  const SinCos arc = sin_cos(w.azimuth_rad + w.sweep_rad * phase.sin);
  const double radius = w.radius_m + 0.12 * (1 - phase.cos) - w.come_close_m * off;
  Vec3 eye{-radius * arc.cos, -radius * arc.sin, w.height_m + 0.1 * twice.sin};
  for (int a = 0; a < 3; ++a) eye[a] += w.tremor_m * tremor.at(t, a);
  const Vec3 target{0.1 * twice.sin, 0.1 * phase.sin, 0.12};
  const Vec3 forward = normalized(target - eye), right = normalized(cross(forward, Vec3{0, 0, 1}));
  const Mat3 R_room_camera = Mat3::from_columns(right, cross(forward, right), forward);
  const Vec3 shake{w.tremor_rad * tremor.at(t, 3) + w.look_up_rad * off,
                   w.tremor_rad * tremor.at(t, 4) + w.look_aside_rad * off, w.tremor_rad * tremor.at(t, 5)};
  return Pose{R_room_camera * rotation_from_vector(shake), eye}.inverse();
}

// Things round the middle, out of each other's way.
void lay_things(Scene& scene, const SceneOptions& options, double azimuth_rad, Random& random) {
  const auto place = [&](double aside_m, double behind_m, double yaw) {
    const SinCos a = sin_cos(azimuth_rad);
    return Pose{rotation_z(yaw), {behind_m * a.cos - aside_m * a.sin, behind_m * a.sin + aside_m * a.cos, 0}};
  };
  const auto any_yaw = [&] { return random.uniform(-kPi, kPi); };
  add_still(scene, make_robot(options.robot, options.laptop).mesh, place(0, 0, any_yaw()));
  add_still(scene, make_toy(random), place(0.42, 0.12, any_yaw()));
  add_still(scene, make_cardboard_box(0.24f, 0.17f, 0.2f, random), place(-0.45, 0.18, any_yaw()));
  add_still(scene, make_cardboard_box(0.3f, 0.3f, 0.34f, random), place(0.2, 0.62, any_yaw()));
  add_still(scene, make_toy(random), place(-0.3, -0.28, any_yaw()));
}

}  // namespace

bool is_hand_scene(const std::string& name) {
  return name == "scan" || name == "scan-fast" || name == "scan-wall";
}

void make_hand_scene(Scene& scene, const SceneOptions& options, Random& random) {
  Way way{};
  way.azimuth_rad = random.uniform(-kPi, kPi);
  way.sweep_rad = 0.46;
  way.radius_m = 1.05;
  way.height_m = 0.75;
  scene.duration_s = way.period_s = 13.36;
  way.tremor_m = 0.006;
  way.tremor_rad = 0.006;
  if (options.name == "scan-fast") {
    way.period_s = 5.5;
    way.tremor_m = 0.015;
    way.tremor_rad = 0.025;
    way.look_up_rad = 1.5;
    way.away_from_s = 6;
    way.away_to_s = 8;
    way.turn_s = 0.5;
  }
  if (options.name == "scan-wall") {
    way.look_aside_rad = 0.3;
    way.look_up_rad = 0.75;
    way.come_close_m = -0.2;
    way.away_from_s = 4;
    way.away_to_s = 9;
    way.turn_s = 1.4;
  }
  if (options.seconds > 0) scene.duration_s = options.seconds;

  Stage stage;
  stage.T_room_stage = {rotation_z(way.azimuth_rad), {}};
  stage.camera_height_m = way.height_m;
  stage.camera_x_m = -way.radius_m;
  stage.near_m = -0.5;
  stage.far_m = 0.5;
  stage.half_width_m = 0.6;
  furnish(scene, stage, {Pose2{}}, true, random);
  lay_things(scene, options, way.azimuth_rad, random);
  const Tremor tremor(random);
  scene.camera_motion = [way, tremor](double t) { return camera_at(way, tremor, t); };
  scene.T_camera_room = scene.camera_motion(0);
}

}  // namespace st::sim
