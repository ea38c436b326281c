// Scenes for a camera in somebody's hand: the room stands still and the Kinect goes round what lies in its
// middle.
#pragma once

#include "hal/sim/random.hpp"
#include "hal/sim/scene.hpp"

namespace st::sim {

// Names of these scenes; see make_hand_scene().
bool is_hand_scene(const std::string& name);

// Fills room, things and the camera's way. Intrinsics must be set.
//   scan        a robot and small things on a floor, seen from an arc to and fro: 2.6 m in 13.3 s
//   scan-fast   the same with a hasty hand, which also looks away to the ceiling for a second
//   scan-wall   the same, and a look at nothing but a flat wall
void make_hand_scene(Scene& scene, const SceneOptions& options, Random& random);

}  // namespace st::sim
