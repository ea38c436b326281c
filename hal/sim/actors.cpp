#include "hal/sim/actors.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "hal/sim/furniture.hpp"
#include "hal/sim/mesh_builder.hpp"

namespace st::sim {
namespace {

// 0 before `from`, 1 after `to`, without a jerk between.
double ease(double t, double from, double to) {
  const double x = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return x * x * x * (x * (6 * x - 15) + 10);
}

Pose on_floor(const Pose2& p, double z = 0) { return {rotation_z(p.yaw), {p.x, p.y, z}}; }

Pose tilted_y(double angle_rad, const Vec3& at) { return {rotation_from_vector({0, angle_rad, 0}), at}; }

Paint cloth(Random& random) {
  const auto level = [&] { return static_cast<float>(random.uniform(0.06, 0.5)); };
  return {level(), level(), level(), static_cast<float>(random.uniform(0.3, 0.6))};
}

// Two legs and a trunk; the walker's own frame has x forward, z = 0 the floor.
struct Walker {
  static constexpr double kThigh_m = 0.47, kShin_m = 0.48, kStep_rad_per_m = 4.4;

  // Pose of a leg's thigh and shin in the walker's frame when it has walked s_m; the hip is lowered so that
  // the standing foot touches the floor.
  struct Leg {
    double thigh, shin;  // angle forward from straight down
  };
  static Leg leg(double s_m, double phase) {
    const double swing = sin_cos(kStep_rad_per_m * s_m + phase).sin,
                 lift = sin_cos(kStep_rad_per_m * s_m + phase).cos;
    const double thigh = 0.42 * swing;
    return {thigh, thigh - (0.12 + 0.55 * std::max(0.0, lift))};
  }
  static double drop(const Leg& l) { return kThigh_m * sin_cos(l.thigh).cos + kShin_m * sin_cos(l.shin).cos; }
};

void add_part(Scene& scene, Mesh mesh, Motion motion, double shadow_radius_m = 0) {
  scene.parts.push_back({std::move(mesh), std::move(motion), -1, shadow_radius_m});
}

// The walker's parts, its place on the floor and the way it has walked given by `where(t, pose, way_m)`.
void add_person(Scene& scene, const std::function<bool(double, Pose2&, double&)>& where, Random& random) {
  const Paint trousers = cloth(random), shirt = cloth(random);
  for (const int side : {-1, 1}) {
    const double phase = side < 0 ? 0 : kPi;
    const auto joint = [where, phase, side](double t, bool shin, Pose& out) {
      Pose2 body{};
      double way = 0;
      if (!where(t, body, way)) return false;
      const Walker::Leg l = Walker::leg(way, phase);
      const double hip = std::max(Walker::drop(l), Walker::drop(Walker::leg(way, phase + kPi)));
      const SinCos a = sin_cos(l.thigh), b = sin_cos(l.shin);
      const Vec3 knee{Walker::kThigh_m * a.sin, 0.10 * side, hip - Walker::kThigh_m * a.cos};
      const Vec3 foot{knee.x + Walker::kShin_m * b.sin, knee.y, knee.z - Walker::kShin_m * b.cos};
      out = on_floor(body) * (shin ? tilted_y(-l.shin, foot) : tilted_y(-l.thigh, knee));
      return true;
    };
    add_part(scene, make_thigh(trousers), [joint](double t, Pose& out) { return joint(t, false, out); });
    add_part(
        scene, make_shin(trousers), [joint](double t, Pose& out) { return joint(t, true, out); }, 0.14);
  }
  add_part(scene, make_torso(shirt), [where](double t, Pose& out) {
    Pose2 body{};
    double way = 0;
    if (!where(t, body, way)) return false;
    out = on_floor(body, Walker::drop(Walker::leg(way, 0)) + 0.02);
    return true;
  });
}

}  // namespace

Motion drive_on_floor(const std::shared_ptr<const Trajectory>& way, double lead_s) {
  return [way, lead_s](double t, Pose& out) {
    out = on_floor(way->at(t + lead_s));
    return true;
  };
}

void add_robot(Scene& scene, const RobotShape& shape, const Motion& motion, const std::string& label) {
  scene.objects.push_back({label, shape.mesh, motion});
  scene.parts.push_back({shape.mesh, motion, static_cast<int>(scene.objects.size()) - 1, shape.radius_m});
}

Motion add_setting_down(Scene& scene, const Stage& stage, const Motion& then, Random& random) {
  const double side = random.uniform() < 0.5 ? -1 : 1;
  const Vec3 outside = stage.T_room_stage.R * Vec3{-0.3, 1.7 * side, 0.75};
  const double twist = random.uniform(-0.6, 0.6);
  Motion robot = [then, outside, twist](double t, Pose& out) {
    if (t < 1.2 || !then(t, out)) return false;
    const double away = 1 - ease(t, 1.2, 3.2), up = 1 - ease(t, 2.6, 4.4);
    out.t += Vec3{outside.x * away, outside.y * away, 0.35 * up + (outside.z - 0.35) * away};
    out.R = rotation_z(twist * up) * rotation_from_vector({0.12 * up, -0.08 * up, 0}) * out.R;
    return true;
  };
  // The arm's far end points to where it came from.
  const double bearing = arc_tan2(-outside.y, -outside.x);
  add_part(scene, make_arm(cloth(random)), [robot, outside, bearing](double t, Pose& out) {
    Pose held;
    if (t > 6.2 || !robot(std::min(t, 4.6), held)) return false;
    const double leave = ease(t, 4.7, 6.2), lift = ease(t, 4.6, 5.2);
    const Vec3 grip = held * Vec3{-0.02, 0, 0.10};
    out = {rotation_z(bearing),
           grip + Vec3{outside.x * leave, outside.y * leave, 0.06 * lift + outside.z * leave}};
    return true;
  });
  return robot;
}

void add_screen(Scene& scene, const Stage& stage, Random& random) {
  const double wide = random.uniform(0.5, 0.6);
  MeshBuilder all;
  all.append(scene.still, Pose{});
  all.append(make_cardboard_box(0.22f, static_cast<float>(wide), 0.42f, random),
             stage.T_room_stage * Pose{rotation_z(random.uniform(-0.08, 0.08)),
                                       {stage.near_m - 0.42, random.uniform(-0.1, 0.1), 0}});
  scene.still = all.take();
}

void add_walker(Scene& scene, const Stage& stage, Random& random) {
  // First behind the robot, then between it and the camera.
  const double behind = stage.far_m + 0.45, before = std::max(stage.near_m - 0.42, stage.camera_x_m + 0.8),
               reach = 2.6, speed = random.uniform(0.9, 1.2);
  const Pose2 frame{stage.T_room_stage.t.x, stage.T_room_stage.t.y,
                    to_roll_pitch_yaw(stage.T_room_stage.R).z};
  const double first = random.uniform(3.5, 4.5), second = random.uniform(10, 11);
  add_person(
      scene,
      [=](double t, Pose2& out, double& way) {
        const double span = 2 * reach / speed;
        if (t >= first && t < first + span) {
          way = (t - first) * speed;
          out = compose(frame, {behind, reach - way, -kPi / 2});
          return true;
        }
        if (t >= second && t < second + span) {
          way = (t - second) * speed;
          out = compose(frame, {before, way - reach, kPi / 2});
          return true;
        }
        return false;
      },
      random);
}

// Each to and fro along a line of its own, with a rest between, from within the first seconds on: four behind
// the robot, two between it and the camera.
void add_crowd(Scene& scene, const Stage& stage, Random& random) {
  constexpr int kPeople = 6, kBehind = 4;
  const double front = std::max(stage.near_m - 0.42, stage.camera_x_m + 0.8), reach = 2.6;
  const Pose2 frame{stage.T_room_stage.t.x, stage.T_room_stage.t.y,
                    to_roll_pitch_yaw(stage.T_room_stage.R).z};
  for (int i = 0; i < kPeople; ++i) {
    const bool behind = i < kBehind;
    const double x = behind ? stage.far_m + 0.45 + 0.4 * i : front - 0.15 * (i - kBehind);
    const double speed = random.uniform(0.7, 1.3), span = 2 * reach / speed;
    const double rest = behind ? random.uniform(0.5, 3) : random.uniform(6, 9),
                 begin = random.uniform(0.2, 6);
    add_person(
        scene,
        [=](double t, Pose2& out, double& way) {
          if (t < begin) return false;
          const double round = (t - begin) / (span + rest),
                       since = (t - begin) - std::floor(round) * (span + rest);
          if (since > span) return false;
          const double side = std::fmod(std::floor(round), 2) == 0 ? 1 : -1;
          way = since * speed;
          out = compose(frame, {x, side * (reach - way), -side * kPi / 2});
          return true;
        },
        random);
  }
}

void add_moved_chair(Scene& scene, const Stage& stage, Random& random) {
  const double side = random.uniform() < 0.5 ? -1 : 1, turned = random.uniform(-kPi, kPi);
  const Vec3 from = stage.T_room_stage * Vec3{stage.far_m + 0.75, side * random.uniform(0.2, 0.5), 0};
  const Vec3 way = stage.T_room_stage.R * Vec3{random.uniform(-0.05, 0.15), -side * 0.5, 0};
  add_part(
      scene, make_chair(random),
      [=](double t, Pose& out) {
        const double s = ease(t, 3, 4.5);
        out = {rotation_z(turned + 0.4 * s), from + way * s};
        return true;
      },
      0.26);
}

void add_pushed_toy(Scene& scene, const Stage& stage, Random& random) {
  const double turned = random.uniform(-kPi, kPi), bend = random.uniform(0.1, 0.25);
  const Pose T_room_stage = stage.T_room_stage;
  const Motion toy_motion = [=](double t, Pose& out) {
    // Pushed over, turned on the spot, rested, pushed back in a bow, turned again.
    const double over = ease(t, 2.0, 5.0), turn = ease(t, 5.5, 8.0), back = ease(t, 10.0, 13.0),
                 again = ease(t, 13.5, 16.0);
    const double y = -0.35 + 0.7 * over - 0.6 * back;
    const double x = bend * (over - over * over) * 4 - 0.15 * back;
    out = T_room_stage *
          Pose{rotation_z(turned + 1.0 * over + 2.2 * turn - 1.4 * back - 1.9 * again), {x, y, 0}};
    return true;
  };
  const Mesh toy = make_toy(random);
  scene.objects.push_back({"object", toy, toy_motion});
  scene.parts.push_back({toy, toy_motion, static_cast<int>(scene.objects.size()) - 1, 0.12});
  // The hand comes from the right, holds the roof while the toy moves, and lets go between.
  add_part(scene, make_arm(cloth(random)), [=](double t, Pose& out) {
    Pose toy_pose;
    toy_motion(t, toy_pose);
    const double near = ease(t, 1.0, 1.9) - ease(t, 8.1, 8.8) + ease(t, 9.2, 9.9) - ease(t, 16.1, 17.0);
    if (near <= 0.001) return false;
    const double away = 1 - near;
    const Vec3 hand = toy_pose.t + T_room_stage.R * Vec3{0.25 * away, -1.5 * away, 0.118 + 0.6 * away};
    out = {T_room_stage.R * rotation_z(1.75), hand};
    return true;
  });
}

}  // namespace st::sim
