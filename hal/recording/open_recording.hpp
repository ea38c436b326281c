// Recordings from disk.
#pragma once

#include <memory>

#include "hal/recording/recording_reader.hpp"
#include "hal/source/frame_source.hpp"

namespace st {

// `options.spec`: the folder. Reads until two usable frames are seen, then hands over a source that begins
// again at the first. `decoder` turns robot.log into odometry; empty: robot.log is not read. Throws Failure
// (kBadInput).
std::unique_ptr<FrameSource> open_recording(const SourceOptions& options, const OdometryDecoder& decoder);

// The name of a folder or device as the run folder carries it: letters, digits and '-'.
std::string short_source_name(const std::string& name);

}  // namespace st
