// Where depth frames come from. A source decodes on a thread of its own; next() only waits and hands over a
// view.
#pragma once

#include <memory>
#include <string>

#include "algo/core/calibration.hpp"
#include "algo/core/records.hpp"

namespace st {

struct SourceInfo {
  std::string name;        // as given on the command line: "kinect:0", "sim:lab", or the recording's folder
  std::string short_name;  // for the run folder: letters, digits, '-'
  Calibration calibration;
  std::string calibration_note;  // one line for the user where a default was taken; else empty
  bool live = false;             // newest frame wins; otherwise every frame comes, in order
  double frame_period_s = 1.0 / 30.0;
  std::uint64_t expected_frames = 0;  // 0: not known
  double wheel_base_m = 0;            // of the robot whose bytes a recording holds; 0: it holds none
};

class FrameSource {
 public:
  enum class Result { kFrame, kEnd, kTimeout, kFault };

  virtual ~FrameSource() = default;
  virtual const SourceInfo& info() const = 0;

  // Starts the source's thread. Allocates here and never later on the caller's thread.
  virtual void start() = 0;

  // Waits for the next frame. No heap on the calling thread. The views in `out` hold until the next call.
  // kFault: the device is gone; what happened is in fault().
  virtual Result next(FrameInput& out, int timeout_ms) = 0;
  virtual std::string fault() const { return {}; }

  // Ends the thread and closes the device. Safe to call twice.
  virtual void stop() = 0;
};

// SRC of the command line: `kinect[:INDEX or SERIAL]`, `sim:SCENE`, or a recording's folder (fakenect
// INDEX.txt or TUM depth.txt). `camera_file` overrides camera.toml when not empty. `robot_state_path`: for
// `sim:` the state file that the simulated Create publishes (hal/create/sim_state.hpp), or empty. Throws
// Failure.
struct SourceOptions {
  std::string spec;
  std::string camera_file;
  std::string robot_state_path;
  bool real_pace = false;  // a recording at the pace it was recorded
  std::uint64_t seed = 1;
};
std::unique_ptr<FrameSource> open_source(const SourceOptions& options);

}  // namespace st
