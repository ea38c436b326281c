// Where the Kinect stands and what stands about in the room, varied by the seed.
#pragma once

#include <vector>

#include "hal/sim/random.hpp"
#include "hal/sim/scene.hpp"

namespace st::sim {

// The room as the camera has it: origin on the floor in the middle of what must be seen, x away from the
// camera, y to its left.
struct Stage {
  Pose T_room_stage;
  double camera_height_m = 1.2;
  double camera_x_m = -1.5;                               // the camera's place, stage frame
  double near_m = -0.5, far_m = 0.5, half_width_m = 0.5;  // extent of what must be seen, stage frame
};

// Points a camera that looks along `azimuth_rad` (room frame) from the height so that robots at all of
// `places` are in view; sets the scene's T_camera_room. Intrinsics must be set.
Stage place_camera(Scene& scene, const std::vector<Pose2>& places, double azimuth_rad, double height_m,
                   Random& random);

// Floor, walls, desk, boxes, chair (when `with_chair`), lamps; nothing nearer than 0.4 m to one of `places`.
void furnish(Scene& scene, const Stage& stage, const std::vector<Pose2>& places, bool with_chair,
             Random& random);

// Adds to the room what never moves.
void add_still(Scene& scene, const Mesh& mesh, const Pose& T_room_mesh);

// A Kinect as they differ from one to the next: a few pixels in focal length and centre, a millimetre in the
// colour camera.
void choose_sensor(Scene& scene, Random& random);

}  // namespace st::sim
