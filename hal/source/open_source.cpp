#include <string_view>

#include "hal/create/odometry_decoder.hpp"
#include "hal/kinect/kinect_source.hpp"
#include "hal/recording/open_recording.hpp"
#include "hal/sim/sim_source.hpp"
#include "hal/source/frame_source.hpp"

namespace st {
namespace {

// Sources that are no folder: NAME, or NAME:WHICH.
struct Device {
  std::string_view name;
  std::unique_ptr<FrameSource> (*open)(const SourceOptions& options);
};
constexpr Device kDevices[] = {
    {"kinect", open_kinect},
    {"sim", open_sim_source},
};

}  // namespace

std::unique_ptr<FrameSource> open_source(const SourceOptions& options) {
  const std::string_view spec = options.spec;
  for (const Device& device : kDevices)
    if (spec.substr(0, spec.find(':')) == device.name) return device.open(options);
  return open_recording(options, decode_odometry);
}

}  // namespace st
