// Writes what a run leaves behind (design, section 3): rows while it runs, the rest when it has ended.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/results/loop_files.hpp"
#include "hal/results/object_files.hpp"
#include "hal/results/run_end.hpp"
#include "hal/results/telemetry.hpp"

namespace st {

class ResultWriter final : public TelemetrySink {
 public:
  // `folder` is there (prepare_run_folder). Makes timing.csv and events.csv. Throws Failure (kBadInput).
  explicit ResultWriter(std::string folder);

  // Telemetry thread. A file that cannot be written (disk full) takes no more rows; the others go on.
  void take(const FrameReport& report) override;
  void flush() override;

  // Any thread, lock-free: a row could not be written. The loop ends the run then, with Ending::kDiskFull.
  bool failed() const { return failed_.load(std::memory_order_relaxed); }

  // After the telemetry thread has ended, in this order. close_rows() adds the events that the end itself is
  // (no_object, interrupted) and flushes; from here on the rows can be read back. write_end() writes meshes,
  // base-N.csv, path.csv and last summary.json. Throws Failure (kBadInput), also when failed().
  void close_rows(const RunEnd& end);
  void write_end(const RunEnd& end, const RunAnalysis& analysis);

  const std::string& folder() const { return folder_; }

 private:
  ObjectFiles* files_of(int id);
  void close_files_of(int id);
  void take_camera(double t_s, const CameraSample& sample);
  void note(const std::string& error);

  std::string folder_;
  LineFile timing_, events_;
  std::optional<LineFile> camera_;                     // camera.tum, from the first pose of a scan
  std::vector<std::unique_ptr<ObjectFiles>> objects_;  // open files: an object that lost its slot has none
  std::vector<int> confirmed_;                         // every object that ever had files
  TimingStatistics statistics_;
  std::atomic<bool> failed_{false};
  std::string first_error_;
};

}  // namespace st
