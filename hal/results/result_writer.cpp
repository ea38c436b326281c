#include "hal/results/result_writer.hpp"

#include <algorithm>
#include <utility>

#include "hal/error.hpp"
#include "hal/results/csv_table.hpp"
#include "hal/results/ply_file.hpp"
#include "hal/results/run_hash.hpp"
#include "hal/results/summary_file.hpp"
#include "hal/results/text_format.hpp"

namespace st {
namespace {

std::string numbered(const std::string& folder, const char* prefix, int id, const char* suffix) {
  return folder + "/" + prefix + std::to_string(id) + suffix;
}

template <std::size_t N>
void write_rows(const std::string& path, const char* header, const std::vector<std::array<double, N>>& rows) {
  const double* values = rows.empty() ? nullptr : rows.front().data();
  write_whole_file(path, format_csv(header, N, values, rows.size(), kMetreDecimals));
}

}  // namespace

ResultWriter::ResultWriter(std::string folder)
    : folder_(std::move(folder)), timing_(folder_ + "/timing.csv"), events_(folder_ + "/events.csv") {
  timing_.line() += timing_columns() + '\n';
  events_.line() += std::string(kEventColumns) + '\n';
  flush();
}

void ResultWriter::note(const std::string& error) {
  if (error.empty() || failed()) return;
  first_error_ = error;
  failed_.store(true, std::memory_order_relaxed);
}

// The object's files; made at its first sample, which is its confirmation. Null when they cannot be opened.
ObjectFiles* ResultWriter::files_of(int id) {
  for (const auto& files : objects_)
    if (files->id() == id) return files.get();
  const bool known = std::ranges::find(confirmed_, id) != confirmed_.end();
  try {
    objects_.push_back(
        std::make_unique<ObjectFiles>(folder_, id, known ? LineFile::Open::kContinue : LineFile::Open::kNew));
    if (!known) confirmed_.push_back(id);
    return objects_.back().get();
  } catch (const Failure& failure) {
    note(failure.what());
    return nullptr;
  }
}

void ResultWriter::take(const FrameReport& report) {
  for (const ObjectSample& sample : report.objects)
    if (ObjectFiles* files = files_of(sample.id)) files->take(report.t_s, sample);
  if (report.has_camera) take_camera(report.t_s, report.camera);
  for (const Event& event : report.events) {
    append_event_row(events_.line(), event);
    if (event.kind == EventKind::kEvicted) close_files_of(event.object);
  }
  append_timing_row(timing_.line(), report);
  statistics_.take(report);
}

void ResultWriter::take_camera(double t_s, const CameraSample& sample) {
  if (sample.state != TrackState::kGood) return;
  try {
    if (!camera_) camera_.emplace(folder_ + "/camera.tum");
    append_tum_row(camera_->line(), t_s, sample.T_world_camera);
  } catch (const Failure& failure) {
    note(failure.what());
  }
}

// Files are closed with the track, so that a long run with many movers does not run out of file descriptors.
void ResultWriter::close_files_of(int id) {
  for (const auto& files : objects_)
    if (files->id() == id && !files->flush()) note(files->error());
  std::erase_if(objects_, [id](const auto& files) { return files->id() == id; });
}

void ResultWriter::flush() {
  for (const auto& files : objects_)
    if (!files->flush()) note(files->error());
  if (camera_ && !camera_->flush()) note(camera_->error());
  if (!events_.flush()) note(events_.error());
  if (!timing_.flush()) note(timing_.error());
}

void ResultWriter::close_rows(const RunEnd& end) {
  const auto add = [&](EventKind kind, double a) {
    append_event_row(events_.line(), {end.last_t_s, kind, 0, a, 0, 0});
  };
  if (confirmed_.empty() && end.info.mode != "scan") add(EventKind::kNoObject, 0);
  if (end.ending == Ending::kInterrupted) add(EventKind::kInterrupted, end.signal);
  flush();
}

void ResultWriter::write_end(const RunEnd& end, const RunAnalysis& analysis) {
  for (const ObjectEnd& object : end.objects)
    if (!object.mesh.vertices.empty())
      write_whole_file(numbered(folder_, "object-", object.id, ".ply"), format_ply(object.mesh));
  if (!end.camera.scene.vertices.empty())
    write_whole_file(folder_ + "/scene.ply", format_ply(end.camera.scene));
  for (const ObjectAnalysis& object : analysis.objects)
    if (object.has_base)
      write_rows(numbered(folder_, "base-", object.id, ".csv"), "t,x,y,yaw", object.base.rows);
  if (analysis.has_path) write_rows(folder_ + "/path.csv", "t,x,y,yaw,v,w", analysis.path.rows);
  // Without all rows the run is not whole: no summary, so that every tool takes it as interrupted.
  if (failed()) throw Failure(ExitCode::kBadInput, first_error_);
  write_whole_file(folder_ + "/summary.json",
                   format_summary(end, analysis, statistics_.summary(), deterministic_hash(folder_)));
}

}  // namespace st
