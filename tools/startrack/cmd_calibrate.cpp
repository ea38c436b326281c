// startrack calibrate: what this robot's wheels and this camera's delay truly are, from a run.
#include <cmath>
#include <cstdio>
#include <memory>

#include "algo/control/dead_reckoning.hpp"
#include "algo/control/wheel_fit.hpp"
#include "algo/core/scalar_math.hpp"
#include "firmware_like/run_study.hpp"
#include "hal/create/wheel_log.hpp"
#include "hal/create/wheels_file.hpp"
#include "hal/error.hpp"
#include "hal/results/line_file.hpp"
#include "hal/results/run_record.hpp"
#include "tools/report/run_report.hpp"
#include "tools/startrack/commands.hpp"
#include "tools/startrack/out_file.hpp"

namespace st {
namespace {

struct Arguments {
  std::vector<std::string> runs, recordings;
  OutFile out{"robot.toml"};
};

// One drive: where the base was seen, and what the wheels told.
struct Drive {
  std::string name;
  std::vector<PlanarSample> base;
  WheelLog log;
};

std::vector<PlanarSample> base_of(const std::string& folder) {
  const RunRecord run = read_run(folder);
  const RunStudy study = study_record(run);
  int robot = study.path.object;
  for (const RunRecord::EventRow& event : run.events)
    if (event.event == name_of(EventKind::kSteeringObject)) robot = event.object;
  const ObjectStudy* best = nullptr;
  for (const ObjectStudy& object : study.objects) {
    if (!object.has_base || (robot != 0 && object.id != robot)) continue;
    if (best == nullptr || object.path_length_m > best->path_length_m) best = &object;
  }
  if (best == nullptr)
    throw Failure(ExitCode::kBadInput, folder +
                                           ": nothing in it drove like a robot; drive a square or an "
                                           "eight before the camera");
  return best->driven;
}

// The drives one after the other, an hour apart, so that no stretch spans two.
struct Together {
  std::vector<PlanarSample> base;
  std::vector<WheelMark> marks;
};
Together join(const std::vector<Drive>& drives) {
  Together all;
  WheelMark at;
  double shift_s = 0;
  for (const Drive& drive : drives) {
    if (drive.base.empty() || drive.log.travel.empty()) continue;
    shift_s += 3600 - drive.log.travel.front().t_s;
    for (const OdometrySample& sample : drive.log.travel) {
      at = {sample.t_s + shift_s, at.left_m + sample.left_m, at.right_m + sample.right_m};
      all.marks.push_back(at);
    }
    for (PlanarSample sample : drive.base) {
      sample.t_s += shift_s;
      all.base.push_back(sample);
    }
    shift_s += drive.log.travel.back().t_s;
  }
  return all;
}

// Where the drive ended by its wheels, less where it was seen to end: in the frame of its start. UMBmark's
// measure of one square.
Pose2 end_error(const Drive& drive, const WheelFit& fit, bool calibrated) {
  constexpr std::size_t kMean = 10;
  DeadReckoning reckoning(calibrated ? fit.wheel_base_m : drive.log.wheels.wheel_base_m);
  Pose2 begin, end;
  const auto seen = [&](std::size_t i) {
    const PlanarSample& p = drive.base[i];
    return Pose2{p.x_m, p.y_m, p.yaw_rad};
  };
  bool begun = false;
  for (OdometrySample sample : drive.log.travel) {
    if (sample.t_s < drive.base.front().t_s - fit.lag_s || sample.t_s > drive.base.back().t_s - fit.lag_s)
      continue;
    if (calibrated) sample.left_m *= fit.left_scale, sample.right_m *= fit.right_scale;
    reckoning.add(sample);
    begun = true;
  }
  if (!begun || drive.base.size() < 2 * kMean) return {};
  begin = seen(0);
  end = seen(drive.base.size() - 1);
  const Pose2 driven = compose(inverse(begin), end);
  return {reckoning.pose().x - driven.x, reckoning.pose().y - driven.y,
          wrap_angle(reckoning.pose().yaw - driven.yaw)};
}

int calibrate(const Arguments& arguments) {
  arguments.out.check(arguments.out.path);
  if (arguments.runs.size() != arguments.recordings.size())
    throw Failure(ExitCode::kBadInput, "calibrate robot: give a --recording for every --run, in their order");
  std::vector<Drive> drives;
  // All counted by the wheels of the first drive, whatever each was driven with.
  for (const std::string& recording : arguments.recordings)
    drives.push_back({{}, {}, read_wheel_log(recording, drives.empty() ? nullptr : &drives.front().log)});
  for (std::size_t i = 0; i < drives.size(); ++i) {
    drives[i].name = arguments.runs[i];
    drives[i].base = base_of(arguments.runs[i]);
  }
  const Together all = join(drives);
  std::vector<FitWindow> memory(kFitWindows);
  const WheelFit fit = fit_wheels(all.base, all.marks, memory);
  if (!fit.valid)
    throw Failure(ExitCode::kBadInput,
                  "calibrate robot: the drive does not tell the wheels; drive squares both ways "
                  "(examples/paths/umbmark-left.toml and umbmark-right.toml) in sight of the camera");
  const RobotGeometry& before = drives.front().log.wheels;
  MeasuredRobot robot;
  const double mean = 0.5 * (fit.left_scale + fit.right_scale);
  robot.wheels = {fit.wheel_base_m, before.wheel_diameter_m * mean, before.counts_per_turn,
                  before.right_to_left * fit.right_scale / fit.left_scale};
  robot.camera_lag_s = fit.lag_s;
  std::printf("wheel base        %.1f mm (was %.1f, sigma %.1f)\n", 1000 * fit.wheel_base_m,
              1000 * before.wheel_base_m, 1000 * fit.sigma_base_m);
  std::printf("wheel diameter    %.2f mm (was %.2f)\n", 1000 * robot.wheels.wheel_diameter_m,
              1000 * before.wheel_diameter_m);
  std::printf("right to left     %.4f (was %.4f, sigma %.4f)\n", robot.wheels.right_to_left,
              before.right_to_left, fit.sigma_scale);
  std::printf("camera's lag      %.1f ms beside the wheels' reports\n", 1000 * fit.lag_s);
  std::printf("from              %.1f m and %.0f deg of driving; turns fit to %.2f deg in half a second\n",
              fit.way_m, fit.turn_rad * 180 / kPi, fit.misfit_rad * 180 / kPi);
  for (const Drive& drive : drives) {
    const Pose2 raw = end_error(drive, fit, false), now = end_error(drive, fit, true);
    std::printf(
        "UMBmark           %s: odometry ends %.0f mm and %.1f deg off, calibrated %.0f mm and %.1f deg\n",
        drive.name.c_str(), 1000 * std::hypot(raw.x, raw.y), raw.yaw * 180 / kPi,
        1000 * std::hypot(now.x, now.y), now.yaw * 180 / kPi);
  }
  write_whole_file(arguments.out.path, format_wheels_toml(robot));
  std::printf("wheels: %s\n", arguments.out.path.c_str());
  return static_cast<int>(ExitCode::kDone);
}

}  // namespace

void add_calibrate(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("calibrate", "measure this robot, or this camera, from recordings");
  command->require_subcommand(1);
  CLI::App* robot = command->add_subcommand(
      "robot", "wheel sizes, wheel base and the camera's lag, from tracked drives with their robot.log");
  robot->footer(
      "Drive squares both ways, then measure, then drive with what was measured:\n"
      "  startrack run --source kinect --robot /dev/ttyUSB0 --path examples/paths/umbmark-left.toml --record "
      "rec-l "
      "--out run-l\n"
      "  startrack run --source kinect --robot /dev/ttyUSB0 --path examples/paths/umbmark-right.toml "
      "--record "
      "rec-r --out run-r\n"
      "  startrack calibrate robot --run run-l run-r --recording rec-l rec-r\n"
      "  startrack drive --robot /dev/ttyUSB0 --wheels robot.toml --path examples/paths/square-1m.toml");
  robot->add_option("--run", arguments->runs, "run folders")->required()->type_name("RUN...");
  robot->add_option("--recording", arguments->recordings, "the recordings of those runs, in their order")
      ->required()
      ->type_name("REC...");
  arguments->out.add_options(*robot, "file to write (default: robot.toml)", "FILE");
  robot->callback([arguments, &exit_code] { exit_code = calibrate(*arguments); });
  add_calibrate_depth(*command, exit_code);
}

}  // namespace st
