#include "hal/results/loop_files.hpp"

#include "hal/results/text_format.hpp"

namespace st {

std::string timing_columns() {
  std::string header = "t,frame";
  for (int i = 0; i < kStageCount; ++i) header += std::string(",") + name_of(static_cast<Stage>(i)) + "_us";
  return header + ",frame_us,cpu_us,level,age_us";
}

void append_timing_row(std::string& out, const FrameReport& report) {
  const auto append_us = [&out](float us) {
    out += ',';
    append_fixed(out, static_cast<double>(us), kMicrosecondDecimals);
  };
  append_fixed(out, report.t_s, kStampDecimals);
  out += ',';
  append_integer(out, static_cast<std::int64_t>(report.index));
  for (const float stage_us : report.stage_us) append_us(stage_us);
  append_us(report.frame_us);
  append_us(report.cpu_us);
  out += ',';
  append_integer(out, report.level);
  append_us(report.age_us);
  out += '\n';
}

void append_event_row(std::string& out, const Event& event) {
  constexpr int kDecimals = 6;
  append_fixed(out, event.t_s, kStampDecimals);
  out += ',';
  out += name_of(event.kind);
  out += ',';
  append_integer(out, event.object);
  for (const double value : {event.a, event.b, event.c}) {
    out += ',';
    append_fixed(out, value, kDecimals);
  }
  out += '\n';
}

void TimingStatistics::take(const FrameReport& report) {
  frame_.add(static_cast<double>(report.frame_us));
  cpu_.add(static_cast<double>(report.cpu_us));
  for (int i = 0; i < kStageCount; ++i) stages_[i].add(static_cast<double>(report.stage_us[i]));
}

TimingSummary TimingStatistics::summary() const {
  TimingSummary all{frame_.summary(), cpu_.summary(), {}};
  for (int i = 0; i < kStageCount; ++i) all.stages[i] = stages_[i].summary();
  return all;
}

}  // namespace st
