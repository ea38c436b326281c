// The end of a run: from the last row to summary.json.
#pragma once

#include <span>

#include "algo/control/path_sample.hpp"
#include "hal/results/result_writer.hpp"

namespace st {

// After the telemetry thread has ended and the robot stands. Reads the object files back, learns bases and
// path errors from them (run_study.hpp) and writes the rest. `path` in the frame of its start; empty without
// one. Allocates. Throws Failure (kBadInput) when the disk was or is full.
void finish_run(ResultWriter& writer, const RunEnd& end, std::span<const PathSample> path);

}  // namespace st
