// startrack calibrate depth: what this Kinect adds to a flat floor, into a camera.toml.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"
#include "hal/recording/camera_file.hpp"
#include "hal/results/line_file.hpp"
#include "hal/source/frame_source.hpp"
#include "hal/system/stop_signal.hpp"
#include "tools/calibrate/depth_fit.hpp"
#include "tools/startrack/commands.hpp"
#include "tools/startrack/out_file.hpp"

namespace st {
namespace {

struct Arguments {
  std::vector<std::string> recordings;
  std::vector<double> heights_m;
  std::string camera_file;
  OutFile out{"camera.toml"};
  int frames = 150;
};

struct Seen {
  std::string name;
  FloorView view;
  Floor floor;
};

void say_progress(const std::string& name, int frames, int of, bool last) {
  if (isatty(STDERR_FILENO) == 0 || (frames % 15 != 0 && !last)) return;
  std::fprintf(stderr, "\r%s: %d of at most %d frames %s", name.c_str(), frames, of, last ? "\n" : "");
}

// The calibration of all recordings is that of the first: they are one Kinect's.
Seen look(const std::string& recording, const Arguments& arguments, Calibration& calibration) {
  SourceOptions options;
  options.spec = recording;
  options.camera_file = arguments.camera_file;
  const std::unique_ptr<FrameSource> source = open_source(options);
  const SourceInfo& info = source->info();
  if (info.calibration.encoding != DepthEncoding::kRaw11)
    throw Failure(ExitCode::kBadInput, recording +
                                           ": holds metres, not a Kinect's raw readings; record the floor "
                                           "with startrack record");
  if (recording == arguments.recordings.front()) {
    calibration = info.calibration;
    calibration.correction = {};
  }
  const Calibration& own = info.calibration;
  if (own.depth.width != calibration.depth.width || own.depth.height != calibration.depth.height ||
      own.raw_a != calibration.raw_a || own.raw_b != calibration.raw_b)
    throw Failure(ExitCode::kBadInput, recording + ": is of another Kinect than " +
                                           arguments.recordings.front() + "; calibrate each by itself");
  Seen seen{recording, FloorView(calibration), {}};
  source->start();
  FrameInput frame;
  while (seen.view.frames() < arguments.frames && stop_signal() == 0) {
    const auto result = source->next(frame, 100);
    if (result == FrameSource::Result::kTimeout) continue;
    if (result != FrameSource::Result::kFrame) break;
    seen.view.add(frame);
    say_progress(recording, seen.view.frames(), arguments.frames, false);
  }
  say_progress(recording, seen.view.frames(), arguments.frames, true);
  source->stop();
  seen.floor = seen.view.find_floor();
  if (!seen.floor.found && stop_signal() == 0)
    throw Failure(ExitCode::kBadInput, recording +
                                           ": no floor in it; point the Kinect at a bare, flat floor that "
                                           "fills the image, hold still and record again");
  return seen;
}

double degrees_of_cosine(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / kPi; }

void print_floors(const std::vector<Seen>& views, const Calibration& calibration, const DepthFit& fit,
                  const std::vector<double>& heights_m) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const FloorPlane plane = plane_of(calibration, fit.floors[i]);
    std::printf("floor             %s: %.0f mm below the camera", views[i].name.c_str(),
                1000 * plane.height_m);
    if (i < heights_m.size()) std::printf(" (tape: %.0f)", 1000 * heights_m[i]);
    std::printf(", camera looks down by %.1f deg", 90 - degrees_of_cosine(-plane.up.z));
    if (views[i].view.has_gravity())
      std::printf("; the accelerometer is %.1f deg off",
                  degrees_of_cosine(dot(plane.up, views[i].view.up())));
    std::printf("\n");
  }
}

void print_fit(const Calibration& calibration, const DepthFit& fit) {
  constexpr double kAt_m = 2, kMostOfIt = 0.8;
  const double mm_per_step = 1000 * kAt_m * kAt_m / calibration.raw_a;
  std::printf(
      "bow of the floor  %.2f steps RMS (%.1f mm at 2 m) before, %.2f (%.1f mm) after, on pixels held back\n",
      fit.before_steps, fit.before_steps * mm_per_step, fit.after_steps, fit.after_steps * mm_per_step);
  if (!fit.worth_it()) {
    std::printf("correction        none: what is left is the noise of single patches\n");
    return;
  }
  std::printf("correction        at most %.2f steps (%.1f mm at 2 m), known in %.0f %% of the image\n",
              fit.largest_steps, fit.largest_steps * mm_per_step, 100 * fit.seen_share);
  if (fit.seen_share < kMostOfIt)
    std::printf(
        "                  the rest goes uncorrected: give a second recording that looks more steeply "
        "down\n");
}

void fit_constant(const Arguments& arguments, const DepthFit& fit, Calibration& calibration) {
  constexpr double kUseful_steps = 2, kPlausible_steps = 12;
  const HeightFit heights = fit_heights(calibration, fit.floors, arguments.heights_m);
  const double moved = heights.raw_b - calibration.raw_b;
  if (!(heights.sigma_steps < kUseful_steps)) {
    std::printf(
        "raw_b             stays %.2f: a tape 3 mm off would move it by %.1f steps; look more steeply down\n",
        calibration.raw_b, heights.sigma_steps);
  } else if (std::fabs(moved) > kPlausible_steps) {
    std::printf(
        "raw_b             stays %.2f: by the tape it would be %.1f steps off; measure the height again\n",
        calibration.raw_b, moved);
  } else {
    std::printf("raw_b             %.2f (was %.2f, sigma %.2f with a tape that is right within 3 mm)\n",
                heights.raw_b, calibration.raw_b, heights.sigma_steps);
    calibration.raw_b = heights.raw_b;
  }
}

int calibrate(const Arguments& arguments) {
  if (!arguments.heights_m.empty() && arguments.heights_m.size() != arguments.recordings.size())
    throw Failure(ExitCode::kBadInput,
                  "calibrate depth: give a --height-m for every recording, in their order, or none");
  arguments.out.check(arguments.out.path);
  watch_stop_signals();
  Calibration calibration;
  std::vector<Seen> views;
  for (const std::string& recording : arguments.recordings)
    if (stop_signal() == 0) views.push_back(look(recording, arguments, calibration));
  if (stop_signal() != 0) return static_cast<int>(ExitCode::kInterrupted);
  std::vector<FloorSamples> samples;
  for (const Seen& seen : views) samples.push_back(seen.view.samples(seen.floor));
  const DepthFit fit = fit_depth(calibration, samples);
  print_floors(views, calibration, fit, arguments.heights_m);
  print_fit(calibration, fit);
  if (!arguments.heights_m.empty()) fit_constant(arguments, fit, calibration);
  if (fit.worth_it()) calibration.correction = fit.correction;
  write_whole_file(arguments.out.path, format_camera_toml(calibration));
  std::printf("camera: %s\n", arguments.out.path.c_str());
  return static_cast<int>(ExitCode::kDone);
}

}  // namespace

void add_calibrate_depth(CLI::App& calibrate_command, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* depth =
      calibrate_command.add_subcommand("depth", "what this Kinect's depth adds to a flat floor");
  depth->footer(
      "Point the Kinect at a bare floor that fills the image, steeply and less steeply, 5 s each, then "
      "measure:\n"
      "  startrack record floor-1 --seconds 5\n"
      "  startrack record floor-2 --seconds 5\n"
      "  startrack calibrate depth floor-1 floor-2 --out camera.toml\n"
      "  startrack run --source kinect --camera camera.toml");
  depth->add_option("RECORDING", arguments->recordings, "still recordings of a floor, of one Kinect")
      ->required()
      ->type_name("REC...");
  depth
      ->add_option("--height-m", arguments->heights_m,
                   "the camera's height above the floor by tape, metres, for each recording: corrects raw_b")
      ->check(CLI::Range(0.3, 4.0))
      ->type_name("H...");
  depth
      ->add_option("--camera", arguments->camera_file,
                   "calibration to begin with, instead of the recording's")
      ->type_name("FILE");
  depth->add_option("--frames", arguments->frames, "frames of each recording to average")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  arguments->out.add_options(*depth, "file to write (default: camera.toml)", "FILE");
  depth->callback([arguments, &exit_code] { exit_code = calibrate(*arguments); });
}

}  // namespace st
