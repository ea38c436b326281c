// The report of a run: one page that holds everything it shows.
#pragma once

#include <string>

#include "firmware_like/run_study.hpp"
#include "hal/results/run_record.hpp"

namespace st {

// What the motion in the run says: bases, and the preset path beside the driven one.
RunStudy study_record(const RunRecord& run);

// HTML with its style, figures (SVG), pictures (PNG) and figures as data (JSON) inside; refers to nothing
// outside.
std::string make_report(const RunRecord& run);

// Reads the run and writes report.html into its folder; returns the path of it. Throws Failure (kBadInput).
std::string write_report(const std::string& run_folder);

}  // namespace st
