// `sim:SCENE`: the simulated Kinect as a live frame source.
#pragma once

#include <memory>
#include <string>

#include "algo/core/pose.hpp"
#include "hal/source/frame_source.hpp"

namespace st {

// A thread of its own renders on an absolute clock at the Kinect's rate; the newest frame wins, frames nobody
// took are counted. With options.robot_state_path the first robot stands where the simulated Create's state
// file (SimStateRing) says it was at the instant of exposure; otherwise the scene's script drives it. Colour
// comes, as from a Kinect, from the exposure before. Throws Failure (kBadInput) for an unknown scene,
// (kDeviceFault) for a state file that is none.
std::unique_ptr<FrameSource> open_sim_source(const SourceOptions& options);

// Where the camera of that source stands: takes the room's frame, in which the state file gives the robot's
// pose (the robot starts at its origin, x forward), to the depth camera's optical frame. For comparing with
// the truth.
Pose sim_camera_room(const SourceOptions& options);

}  // namespace st
