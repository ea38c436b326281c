// What the object tracker keeps in memory: planned and bound once, before the first frame.
#include "firmware_like/object_tracker.hpp"

namespace st {

void ObjectTracker::plan_memory(MemoryPlan& plan) {
  plan.add("images of the frame", "firmware_like", parts_[0]);
  plan.add("background and segments", "algo/segmentation", parts_[1]);
  plan.add("models, one volume an object", "algo/volume", parts_[2]);
  plan.add("views of the models", "algo/tracking", parts_[3]);
  plan.add("observed points", "algo/tracking", parts_[4]);
  plan.add("work memory of the fusion", "algo/volume", parts_[5]);
  if (knows_models() || tracks_by_matches()) plan.add("recognition", "algo/recognition", parts_[6]);
  if (tracks_by_matches()) plan.add("features of the frame before", "algo/recognition", parts_[7]);
}

void ObjectTracker::bind_images(Bump& memory) {
  const int width = calibration_.depth.width, height = calibration_.depth.height;
  const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  frame_.bind(memory, width, height);
  rest_z_ = {memory.take<float>(n).data(), width, height};
  registered_color_ = {memory.take<std::uint32_t>(n).data(), width, height};
  const Intrinsics& color = calibration_.color_registered ? calibration_.depth : calibration_.color;
  color_frame_.bind(memory, color.width, color.height);
}

void ObjectTracker::bind_segmenter(Bump& memory) { segmenter_.bind(memory, calibration_); }

void ObjectTracker::bind_volumes(Bump& memory) {
  for (Track& track : tracks_) track.volume.bind(memory, config_.volume_side);
}

void ObjectTracker::bind_views(Bump& memory) {
  const int width = calibration_.depth.width, height = calibration_.depth.height;
  for (Track& track : tracks_) track.rendered.maps.bind(memory, width, height);
  raycast_scratch_.bind(memory, width, height);
  scratch_.bind(memory, width, height);
  if (config_.tracker == TrackerKind::kFrameToFrame)
    for (FrameViewMemory& previous : previous_) previous.bind(memory, width, height);
  if (config_.tracker == TrackerKind::kListing1)
    for (ModelCloud& cloud : clouds_) cloud.bind(memory);
}

void ObjectTracker::bind_points(Bump& memory) {
  points_ = memory.take<ObservedPoint>(kMaxPoints * kMaxObjects);
}

void ObjectTracker::bind_integration(Bump& memory) {
  integrate_scratch_.bind(memory, calibration_.depth.width, calibration_.depth.height, config_.volume_side);
}

}  // namespace st
