// A Kinect on USB, through libfreenect, as a frame source.
#pragma once

#include <memory>

#include "hal/source/frame_source.hpp"

namespace st {

// `options.spec`: `kinect`, `kinect:INDEX` or `kinect:SERIAL`. Opens the device on a thread of its own, since
// control transfers may hang for ever. Throws Failure (kDeviceFault).
std::unique_ptr<FrameSource> open_kinect(const SourceOptions& options);

}  // namespace st
