// Where an object can be in the image.
#pragma once

#include "algo/core/image.hpp"
#include "algo/tracking/track.hpp"

namespace st {

// The pixels that the box can cover at the pose, `margin_px` wider, not clipped to the image. The whole image
// when the box comes close to the camera.
Rect image_box(const Bounds& bounds, const Pose& T_camera_object, const Pinhole& camera, int margin_px);

}  // namespace st
