// What moves in a scene. Every function adds its parts to the scene; the room and the camera must be there.
#pragma once

#include <memory>

#include "hal/sim/robots.hpp"
#include "hal/sim/room.hpp"
#include "hal/sim/trajectory.hpp"

namespace st::sim {

// Follows a way on the floor; `lead_s` is the way's time at the scene's time zero.
Motion drive_on_floor(const std::shared_ptr<const Trajectory>& way, double lead_s);
void add_robot(Scene& scene, const RobotShape& shape, const Motion& motion, const std::string& label);

// An arm brings the robot in from the side, sets it down where `then` begins, lets go and leaves (until 6 s).
// Returns the robot's motion, which is `then` once it stands.
Motion add_setting_down(Scene& scene, const Stage& stage, const Motion& then, Random& random);
void add_screen(Scene& scene, const Stage& stage, Random& random);  // a box that hides the middle of the way
void add_walker(Scene& scene, const Stage& stage, Random& random);  // somebody crosses the picture twice
void add_crowd(Scene& scene, const Stage& stage, Random& random);   // six people go to and fro
void add_moved_chair(Scene& scene, const Stage& stage, Random& random);  // pushed half a metre at 3 to 4.5 s
void add_pushed_toy(Scene& scene, const Stage& stage, Random& random);   // a hand pushes and turns a toy

}  // namespace st::sim
