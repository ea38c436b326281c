// The parts of the report. Each returns a piece of HTML, empty when the run has nothing to show there.
#pragma once

#include <string>

#include "firmware_like/run_study.hpp"
#include "hal/results/run_record.hpp"

namespace st {

struct ReportInput {
  const RunRecord& run;
  const RunStudy& study;
  double t0_s = 0, t1_s = 0;  // first and last frame

  double length_s() const { return t1_s - t0_s; }
};

std::string path_section(const ReportInput& input);    // preset beside actual, the errors, errors over time
std::string motion_section(const ReportInput& input);  // speeds and yaw over time, state of tracking
std::string model_section(const ReportInput& input);   // pictures of the models
std::string scene_section(const ReportInput& input);   // scan mode: the camera's path and the scene
std::string loop_section(const ReportInput& input);    // frame times
std::string event_section(const ReportInput& input);
std::string data_block(const ReportInput& input);  // the figures as JSON, for scripts

// Shared by the sections.
std::string number(double value, int decimals);
std::string figure(const std::string& drawing, const std::string& caption);
std::string section(const std::string& title, const std::string& content);  // empty without content

}  // namespace st
