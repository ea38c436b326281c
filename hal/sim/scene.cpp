#include "hal/sim/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"
#include "hal/sim/actors.hpp"
#include "hal/sim/hand_camera.hpp"
#include "hal/sim/robots.hpp"
#include "hal/sim/room.hpp"
#include "hal/sim/trajectory.hpp"

namespace st::sim {
namespace {

constexpr const char* kNames[] = {"lab",
                                  "circle",
                                  "square",
                                  "figure8",
                                  "spin-in-place",
                                  "start-stop",
                                  "fast",
                                  "arrives-late",
                                  "present-from-start",
                                  "occluded",
                                  "leaves-and-returns",
                                  "two-robots",
                                  "walking-legs",
                                  "set-down-by-hand",
                                  "hand-moved-object",
                                  "chair-moved",
                                  "crowd",
                                  "thing",
                                  "empty",
                                  "scan",
                                  "scan-fast",
                                  "scan-wall"};
constexpr double kTurn = 2 * kPi;
constexpr double kThingBend_m = 0.3;  // radius of the circle that a made-up thing is led along

// What the robots of a scene do, before there is a room round them.
struct RobotPlan {
  Pose2 start{};
  double start_s = 1.5;
  std::vector<DriveCommand> commands;
  RobotModel model = RobotModel::kCreate2;
  bool laptop = false;
};

struct Plan {
  std::vector<RobotPlan> robots;
  double duration_s = 20;
  // Azimuth of the camera in the room: any, unless the scene needs the robot to cross the picture.
  double azimuth_rad = 0;
  std::vector<Pose2> must_see;  // when not the whole way of the robots
};

std::vector<DriveCommand> circle_commands(double radius_m, double v_mps, double turns) {
  return Moves().bend(radius_m, kTurn * turns, v_mps).done();
}

std::vector<DriveCommand> square_commands(double side_m) {
  Moves m;
  for (int i = 0; i < 4; ++i) m.straight(side_m, 0.2).wait(0.3).turn(kPi / 2, 0.8).wait(0.3);
  return m.done();
}

std::vector<DriveCommand> back_and_forth(double way_m, double v_mps) {
  Moves m;
  for (int i = 0; i < 2; ++i)
    m.straight(0.5 * way_m, v_mps)
        .wait(1.2)
        .straight(0.5 * way_m, v_mps)
        .wait(0.8)
        .back(way_m, v_mps)
        .wait(1.5);
  return m.done();
}

std::vector<Pose2> line_of_places(double from_x, double to_x) {
  std::vector<Pose2> places;
  for (double x = from_x; x <= to_x; x += 0.1) places.push_back({x, 0, 0});
  return places;
}

// Scenes that differ only in what the robot does.
struct Script {
  const char* name;
  double duration_s;
  std::vector<DriveCommand> commands;
};

Script script_of(const std::string& name) {
  const Script scripts[] = {
      {"square", 29, square_commands(0.8)},
      {"figure8", 29, Moves().bend(0.4, kTurn, 0.2).bend(-0.4, kTurn, 0.2).done()},
      {"spin-in-place", 33, Moves().turn(2 * kTurn, 0.7).wait(1).turn(-2 * kTurn, 1.2).done()},
      {"start-stop", 26, back_and_forth(0.9, 0.25)},
      {"fast", 18, Moves().bend(0.5, 2 * kTurn, 0.45).straight(0.3, 0.45).done()},
      {"arrives-late", 24, Moves().straight(2.6, 0.25).wait(1).turn(kPi, 0.8).straight(0.5, 0.2).done()},
      {"present-from-start", 16, circle_commands(0.5, 0.2, 1.3)},
      {"occluded", 20, Moves().straight(1.5, 0.2).wait(1).back(1.5, 0.2).done()},
      {"leaves-and-returns", 23, Moves().straight(2.4, 0.3).wait(2).back(2.4, 0.3).done()},
      {"set-down-by-hand", 20, circle_commands(0.45, 0.2, 0.8)},
      {"chair-moved", 26, circle_commands(0.5, 0.2, 1.05)},
      {"thing", 12, Moves().bend(kThingBend_m, kTurn * 1.1, 0.2).done()},
      {"empty", 34, {}},
      {"hand-moved-object", 18, {}},
  };
  for (const Script& s : scripts)
    if (name == s.name) return s;
  return {"lab", 20, circle_commands(0.5, 0.2, 1.05)};
}

// Round the circle of a made-up thing, so far out that all of the thing is in view, and up to 0.4 m
// farther: cameras stand near and far.
std::vector<Pose2> about_the_bend(double radius_m, Random& random) {
  constexpr double kSeenAnyway_m = 0.19;
  const double reach = kThingBend_m + std::max(0.0, radius_m - kSeenAnyway_m) + random.uniform(0, 0.4);
  std::vector<Pose2> places;
  for (int i = 0; i < 16; ++i) {
    const SinCos sc = sin_cos(i * kTurn / 16);
    places.push_back({reach * sc.cos, kThingBend_m + reach * sc.sin, 0});
  }
  return places;
}

// The second robot of two-robots: to and fro beside the first one's circle.
RobotPlan second_robot(RobotModel first) {
  RobotPlan second;
  second.model = first == RobotModel::kCreate1 ? RobotModel::kCreate2 : RobotModel::kCreate1;
  second.start = {-0.95, 0.1, kPi / 2};
  second.start_s = 2.5;
  second.commands = Moves()
                        .straight(0.8, 0.2)
                        .wait(0.5)
                        .turn(kPi, 0.9)
                        .wait(0.5)
                        .straight(0.8, 0.2)
                        .turn(-kPi / 2, 0.9)
                        .done();
  return second;
}

Plan plan_scene(const SceneOptions& options, Random& random) {
  const std::string& name = options.name;
  const Script script = script_of(name);
  Plan plan;
  plan.duration_s = script.duration_s;
  plan.azimuth_rad = random.uniform(-kPi, kPi);
  const double across = (random.uniform() < 0.5 ? -1 : 1) * kPi / 2 + random.uniform(-0.25, 0.25);
  if (name == "arrives-late" || name == "occluded" || name == "leaves-and-returns") plan.azimuth_rad = across;
  if (name == "arrives-late") plan.must_see = line_of_places(2.0, 2.9);
  if (name == "thing") plan.must_see = about_the_bend(radius_of(make_thing(options.thing)), random);
  if (name == "leaves-and-returns") plan.must_see = line_of_places(-0.2, 0.6);
  if (name == "empty" || name == "hand-moved-object") {
    plan.must_see = line_of_places(-0.5, 0.5);
    return plan;
  }
  RobotPlan robot;
  robot.model = options.robot;
  robot.laptop = options.laptop;
  robot.commands = script.commands;
  if (name == "arrives-late") robot.start_s = 4;
  if (name == "present-from-start") robot.start_s = -2;
  if (name == "set-down-by-hand") robot.start_s = 7.5;
  if (name == "chair-moved") robot.start_s = 7;
  if (!options.path.empty()) {
    robot.commands = options.path;
    plan.must_see.clear();
    plan.duration_s = robot.start_s + options.path.back().t_s + 1.5;
  }
  plan.robots.push_back(robot);
  if (name == "two-robots") plan.robots.push_back(second_robot(options.robot));
  if (name == "crowd") {  // a second robot of the same kind
    plan.robots.push_back(second_robot(options.robot));
    plan.robots.back().model = options.robot;
    plan.robots.back().start_s = random.uniform(0.5, 3.0);
  }
  return plan;
}

RobotShape thing_shape(const ThingSpec& spec) {
  RobotShape shape;
  shape.mesh = make_thing(spec);
  shape.radius_m = radius_of(shape.mesh);
  return shape;
}

// Led along the way with one side or another in front.
Motion turned_by(const Motion& motion, double angle_rad) {
  return [motion, R = rotation_z(angle_rad)](double t, Pose& out) {
    if (!motion(t, out)) return false;
    out.R = out.R * R;
    return true;
  };
}

bool in_list(const std::string& name) {
  return std::any_of(std::begin(kNames), std::end(kNames), [&](const char* n) { return name == n; });
}

std::string all_names() {
  std::string list;
  for (const char* n : kNames) list += std::string(list.empty() ? "" : ", ") + n;
  return list;
}

}  // namespace

std::span<const char* const> scene_names() { return kNames; }

Scene make_scene(const SceneOptions& options) {
  if (!in_list(options.name))
    throw Failure(ExitCode::kBadInput,
                  "scene '" + options.name + "' is not known; take one of: " + all_names());
  Scene scene;
  scene.name = options.name;
  scene.seed = options.seed;
  Random random(options.seed, 0x5ce7e), sensor_random(options.seed, 0x5e45),
      room_random(options.seed, 0x4004);
  choose_sensor(scene, sensor_random);
  if (options.bow_steps > 0) scene.depth.bias = options.bow_steps;
  if (is_hand_scene(options.name)) {
    make_hand_scene(scene, options, room_random);
    return scene;
  }
  const Plan plan = plan_scene(options, random);
  scene.duration_s = options.seconds > 0 ? options.seconds : plan.duration_s;

  std::vector<Pose2> places;  // of all robots, all the time
  std::vector<std::shared_ptr<const Trajectory>> ways;
  for (const RobotPlan& r : plan.robots) {
    const double base = r.model == RobotModel::kCreate1 ? 0.258 : 0.235;
    const DiffDriveErrors errors{1 + 0.012 * random.normal(), 1 + 0.012 * random.normal(), 0.015};
    // A start before zero: the robot is on its way when the recording begins.
    const double lead = std::max(0.0, -r.start_s);
    auto way = std::make_shared<Trajectory>(r.start, r.start_s + lead, scene.duration_s + lead + 1,
                                            r.commands, base, errors, random.bits());
    places.insert(places.end(), way->poses().begin(), way->poses().end());
    ways.push_back(way);
  }
  const std::vector<Pose2>& seen = plan.must_see.empty() ? places : plan.must_see;
  const Stage stage =
      place_camera(scene, seen, plan.azimuth_rad, room_random.uniform(1.05, 1.3), room_random);
  if (places.empty()) places = seen;
  furnish(scene, stage, places, options.name != "chair-moved", room_random);

  for (std::size_t i = 0; i < plan.robots.size(); ++i) {
    const RobotPlan& r = plan.robots[i];
    const double lead = std::max(0.0, -r.start_s);
    Motion motion = drive_on_floor(ways[i], lead);
    if (options.name == "set-down-by-hand") motion = add_setting_down(scene, stage, motion, random);
    if (options.name == "thing") {
      add_robot(scene, thing_shape(options.thing), turned_by(motion, random.uniform(-kPi, kPi)), "thing");
      continue;
    }
    add_robot(scene, make_robot(r.model, r.laptop), motion,
              plan.robots.size() > 1 ? std::to_string(i + 1) : "robot");
  }
  if (!plan.robots.empty()) {
    scene.preset = ideal_path(plan.robots[0].commands);
    scene.start_s = plan.robots[0].start_s;
    scene.first_robot_part = 0;
  }
  if (options.name == "occluded") add_screen(scene, stage, random);
  if (options.name == "crowd") add_crowd(scene, stage, random);
  if (options.name == "walking-legs") add_walker(scene, stage, random);
  if (options.name == "chair-moved") add_moved_chair(scene, stage, random);
  if (options.name == "hand-moved-object") add_pushed_toy(scene, stage, random);
  return scene;
}

}  // namespace st::sim
