#include "firmware_like/session_end.hpp"

#include "hal/system/stop_signal.hpp"

namespace st {

Ending ending_of(LoopEnd why) {
  switch (why) {
    case LoopEnd::kSignal:
      return Ending::kInterrupted;
    case LoopEnd::kSourceFault:
    case LoopEnd::kRobotFault:
      return Ending::kFault;
    case LoopEnd::kResultsFailed:
      return Ending::kDiskFull;
    default:
      return Ending::kDone;
  }
}

ExitCode exit_code_of(const RunEnd& end) {
  if (end.ending == Ending::kInterrupted) return ExitCode::kInterrupted;
  if (end.ending == Ending::kFault) return ExitCode::kDeviceFault;
  bool well = end.objects.empty();
  for (const ObjectEnd& object : end.objects) well = well || object.good_at_end || object.left_view;
  well = well && (!end.has_camera || end.camera.good_at_end);
  if (!well) return ExitCode::kTrackFailed;
  if (end.info.live && end.deadline_misses * 1000 > end.frames) return ExitCode::kTrackFailed;
  return ExitCode::kDone;
}

std::vector<ObjectEnd> object_ends(const ObjectTracker& tracker, ModelMeshes& meshes) {
  std::vector<ObjectEnd> objects;
  for (const ObjectCount& count : tracker.counts()) {
    ObjectEnd object;
    object.id = count.id;
    object.first_t_s = count.first_t_s;
    object.last_t_s = count.last_t_s;
    object.tracked = count.tracked;
    object.lost = count.lost;
    if (count.aligned > 0)
      object.iterations_mean = static_cast<double>(count.iterations) / static_cast<double>(count.aligned);
    object.good_at_end = count.good_at_end;
    object.left_view = count.left_view;
    for (const Track& track : tracker.tracks())
      if (track.id == count.id && !mesh_unwanted())
        object.mesh = meshes.extract(track.volume, track.T_model_object.inverse());
    objects.push_back(object);
  }
  return objects;
}

MatchingEnd matching_of(const MatchCounts& c) {
  return {c.frames, c.found, c.no_keypoints, c.no_matches, c.no_agreement, c.not_verified};
}

void name_steering_object(const RobotDriver& driver, RunEnd& end) {
  if (driver.picked().id != 0) end.steering_object = driver.picked().id;
  end.path_begins_t_s = driver.path_begins_t_s();
}

}  // namespace st
