// summary.json: one page of a run for scripts. Written last, so that a run without it counts as interrupted.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/results/loop_files.hpp"
#include "hal/results/run_end.hpp"

namespace st {

// Every key of the contract, in its order. `tracked` and `lost` at the top are the sums over the objects;
// `path`, `base` and `T_floor_camera` are null where there is none; `radius_m` stands only where the path is
// a circle.
std::string format_summary(const RunEnd& end, const RunAnalysis& analysis, const TimingSummary& timing,
                           const std::string& hash);

// The parts that tools read back.
struct RunSummary {
  struct Object {
    int id = 0;
    std::string name;
    double path_length_m = 0;
    std::uint64_t tracked = 0, lost = 0;
    bool has_base = false;
    double base_x_m = 0, base_y_m = 0, base_yaw_rad = 0, base_sigma_m = 0, base_sigma_rad = 0;
  };
  std::string version, source, mode, simd, ended, hash;
  std::uint64_t frames = 0, deadline_misses = 0;
  std::vector<Object> objects;
};

// Throws Failure (kBadInput) when the text is not such a summary.
RunSummary parse_summary(std::string_view json, const std::string& name);

}  // namespace st
