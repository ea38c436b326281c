// startrack record: a source's frames to a recording, no tracking.
#include <unistd.h>

#include <cstdio>
#include <string>

#include "hal/create/drive_base.hpp"
#include "hal/error.hpp"
#include "hal/recording/recorder.hpp"
#include "hal/source/frame_source.hpp"
#include "hal/system/stop_signal.hpp"
#include "tools/startrack/commands.hpp"

namespace st {
namespace {

struct RecordArguments {
  std::string folder;
  SourceOptions source;
  RobotOptions robot;  // port empty: none
  double seconds = 0;  // 0: until stopped
};

// Counts what is recorded, and says it while it goes on where somebody looks.
class Progress {
 public:
  void add(const FrameInput& frame, const Recorder& recorder) {
    skipped_ += static_cast<std::uint64_t>(frame.skipped);
    if (isatty(STDERR_FILENO) == 0 || frame.index % 15 != 0) return;
    std::fprintf(stderr, "\r%llu frames, %llu dropped ", static_cast<unsigned long long>(recorder.written()),
                 static_cast<unsigned long long>(recorder.dropped()));
    shown_ = true;
  }
  void end(const Recorder& recorder) const {
    if (shown_) std::fprintf(stderr, "\n");
    if (recorder.dropped() + skipped_ > 0)
      std::fprintf(stderr, "startrack record: %llu frames dropped, since the disk did not keep up\n",
                   static_cast<unsigned long long>(recorder.dropped() + skipped_));
    std::printf("frames: %llu\n", static_cast<unsigned long long>(recorder.written()));
  }

 private:
  std::uint64_t skipped_ = 0;
  bool shown_ = false;
};

int record(const RecordArguments& arguments) {
  make_recording_folder(arguments.folder);
  SourceOptions source_options = arguments.source;
  std::unique_ptr<DriveBase> robot;
  if (!arguments.robot.port.empty()) {
    RobotOptions robot_options = arguments.robot;
    robot_options.log_path = arguments.folder + "/robot.log";
    robot = open_robot(robot_options);
    source_options.robot_state_path = robot->sim_state_path();
  }
  const std::unique_ptr<FrameSource> source = open_source(source_options);
  const SourceInfo& info = source->info();
  if (!info.calibration_note.empty())
    std::fprintf(stderr, "startrack record: %s\n", info.calibration_note.c_str());
  RecorderOptions options;
  options.folder = arguments.folder;
  options.calibration = info.calibration;
  Recorder recorder(options);
  watch_stop_signals();
  source->start();
  Progress progress;
  FrameInput frame;
  RobotStatus status;
  double first_t_s = 0;
  auto result = FrameSource::Result::kTimeout;
  while (stop_signal() == 0 && recorder.failure().empty()) {
    result = source->next(frame, 100);
    if (result == FrameSource::Result::kTimeout) continue;
    if (result != FrameSource::Result::kFrame) break;
    if (frame.index == 0) first_t_s = frame.t_s;
    if (arguments.seconds > 0 && frame.t_s - first_t_s >= arguments.seconds) break;
    // A source that waits for us can wait for the disk as well: frames are dropped live only.
    while (!info.live && stop_signal() == 0 && recorder.failure().empty() && !recorder.wait_for_room(100)) {
    }
    if (robot) robot->poll(frame.odometry, status);
    recorder.add(frame, 0, status.log_bytes);
    progress.add(frame, recorder);
  }
  source->stop();
  if (robot) robot->close();
  recorder.close();
  progress.end(recorder);
  if (!recorder.failure().empty()) throw Failure(ExitCode::kBadInput, recorder.failure());
  if (result == FrameSource::Result::kFault) throw Failure(ExitCode::kDeviceFault, source->fault());
  std::printf("recording: %s\n", arguments.folder.c_str());
  return static_cast<int>(stop_signal() != 0 ? ExitCode::kInterrupted : ExitCode::kDone);
}

}  // namespace

void add_record(CLI::App& app, int& exit_code) {
  auto* command =
      app.add_subcommand("record", "records a Kinect (or another source) to a folder, without tracking");
  auto arguments = std::make_shared<RecordArguments>();
  arguments->source.spec = "kinect";
  command->add_option("DIR", arguments->folder, "new folder for the recording")->required();
  command
      ->add_option("--source", arguments->source.spec, "kinect[:INDEX or SERIAL], sim:SCENE or a recording")
      ->capture_default_str();
  command
      ->add_option(
          "--robot", arguments->robot.port,
          "also record what this robot says and is told; it stands: a serial device, tcp:HOST:PORT or "
          "sim")
      ->type_name("PORT");
  command->add_option("--camera", arguments->source.camera_file,
                      "camera.toml with the calibration of this camera");
  command->add_option("--seconds", arguments->seconds, "stop after so many seconds (0: until Ctrl-C)")
      ->check(CLI::NonNegativeNumber);
  command->footer("Example: startrack record my-recording --seconds 20");
  command->callback([arguments, &exit_code] { exit_code = record(*arguments); });
}

}  // namespace st
