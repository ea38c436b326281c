// The colour image beside the depth image of the same frame.
#include "firmware_like/object_tracker.hpp"

namespace st {

// The part of the colour image that the depth image's `box` may appear in.
void ObjectTracker::look_at_colors(const Rect& box, const LadderStep& step) {
  color_frame_.roi = {0, 0, 0, 0};
  if (frame_.has_color && step.color_term)
    build_color_frame(registration_, frame_.color, frame_.camera, box, color_frame_);
}

// The colours of the track's pixels in this frame, as it was when the colour image was taken; empty where
// there are none.
ImageView<std::uint32_t> ObjectTracker::register_colors(std::size_t k, const Rect& box) {
  if (!frame_.has_color) return {};
  register_color(registration_, frame_.color, to_float(tracks_[k].aligned.color_motion), frame_.depth_z,
                 frame_.owners, static_cast<std::uint8_t>(k + 1), box, frame_.camera, registered_color_);
  return registered_color_;
}

}  // namespace st
