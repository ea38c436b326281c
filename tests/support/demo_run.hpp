// Runs as a tracker would leave them, made from analytic motion and noise: for tests of the files and of the
// report.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "algo/control/path_sample.hpp"
#include "hal/results/ply_file.hpp"
#include "hal/results/result_writer.hpp"
#include "tests/support/robot_motion.hpp"

namespace st {

struct DemoRun {
  std::vector<BaseSampleTruth> driven;  // the base, on the floor
  std::vector<PathSample> path;         // empty: none was given
  Pose2 base{0.012, -0.008, 0.9};       // base in the object's frame
  double noise_m = 0.002, noise_rad = 0.008;
  std::size_t lost_from = 0, lost_to = 0;  // frames without a pose; before them two are predicted
  bool with_object = true;
  Ending ending = Ending::kDone;
};

// A robot told to drive a circle of `radius_m`, one of whose wheels is `wheel_error` larger than it thinks.
DemoRun circle_run(double radius_m, double wheel_error);
// A square with turns on the spot, the turns a little short.
DemoRun square_run(double side_m, double turn_share);

// A disc like a small robot's body, with a print and a bumper, in the object's frame.
Mesh disc_mesh(const Pose2& base);

// The reports of the run, frame by frame.
void for_each_report(const DemoRun& run, const std::function<void(const FrameReport&)>& take);
RunEnd end_of(const DemoRun& run, const Mesh& mesh);
// Everything: rows, end, summary.
void write_demo_run(const DemoRun& run, const std::string& folder);

}  // namespace st
