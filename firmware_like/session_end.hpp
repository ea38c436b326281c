// What a run comes to once its loop has ended: its ending, its exit code, and what became of each object.
#pragma once

#include <vector>

#include "firmware_like/loop.hpp"
#include "firmware_like/model_meshes.hpp"
#include "firmware_like/object_tracker.hpp"
#include "hal/error.hpp"
#include "hal/results/run_end.hpp"

namespace st {

Ending ending_of(LoopEnd why);

// kTrackFailed when an object was confirmed and at the end none is good and none has left through the view's
// edge, when the camera of a scan is lost at the end, or when a live run missed more than 0.1 % of its
// deadlines.
ExitCode exit_code_of(const RunEnd& end);

// Every object that was confirmed, in the order of their numbers; with its mesh, kept by `meshes`, unless a
// second Ctrl-C asked for none.
std::vector<ObjectEnd> object_ends(const ObjectTracker& tracker, ModelMeshes& meshes);

MatchingEnd matching_of(const MatchCounts& counts);

// Which object the robot was, and since when that was known.
void name_steering_object(const RobotDriver& driver, RunEnd& end);

}  // namespace st
