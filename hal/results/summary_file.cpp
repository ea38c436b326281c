#include "hal/results/summary_file.hpp"

#include <nlohmann/json.hpp>

#include "hal/error.hpp"

namespace st {
namespace {

using Json = nlohmann::ordered_json;

Json matrix(const Pose& T) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) rows.push_back({T.R(r, 0), T.R(r, 1), T.R(r, 2), T.t[r]});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

Json durations(const DurationSummary& d) {
  return {{"p50", d.p50_us}, {"p99", d.p99_us}, {"p999", d.p999_us}, {"max", d.max_us}};
}

const ObjectAnalysis* analysis_of(const RunAnalysis& analysis, int id) {
  for (const ObjectAnalysis& object : analysis.objects)
    if (object.id == id) return &object;
  return nullptr;
}

Json object_json(const ObjectEnd& object, const ObjectAnalysis* learned) {
  Json base;
  if (learned != nullptr && learned->has_base)
    base = {{"x", learned->base.x_m},
            {"y", learned->base.y_m},
            {"yaw", learned->base.yaw_rad},
            {"sigma_m", learned->base.sigma_m},
            {"sigma_rad", learned->base.sigma_rad}};
  return {{"id", object.id},
          {"name", object.name.empty() ? "object-" + std::to_string(object.id) : object.name},
          {"model_source", object.model_from_database ? "database" : "new"},
          {"model_id", object.model_id},
          {"first_t", object.first_t_s},
          {"last_t", object.last_t_s},
          {"tracked", object.tracked},
          {"lost", object.lost},
          {"iterations_mean", object.iterations_mean},
          {"path_length_m", learned != nullptr ? learned->path_length_m : 0.0},
          {"T_model_object", matrix(object.T_model_object)},
          {"base", base}};
}

Json path_json(const PathEnd& path) {
  Json json = {{"rmse_as_placed_m", path.rmse_as_placed_m},
               {"rmse_shape_m", path.rmse_shape_m},
               {"max_m", path.max_m},
               {"heading_rmse_rad", path.heading_rmse_rad},
               {"in_band", path.in_band}};
  if (path.is_circle) json["radius_m"] = path.radius_m;
  return json;
}

Json timing_json(const TimingSummary& timing) {
  Json stages = Json::object();
  for (int i = 0; i < kStageCount; ++i) stages[name_of(static_cast<Stage>(i))] = durations(timing.stages[i]);
  return {{"frame_us", durations(timing.frame)}, {"cpu_us", durations(timing.cpu)}, {"stages", stages}};
}

RunSummary::Object read_object(const Json& json) {
  RunSummary::Object object;
  object.id = json.at("id").get<int>();
  object.name = json.at("name").get<std::string>();
  object.path_length_m = json.at("path_length_m").get<double>();
  object.tracked = json.at("tracked").get<std::uint64_t>();
  object.lost = json.at("lost").get<std::uint64_t>();
  const Json& base = json.at("base");
  object.has_base = !base.is_null();
  if (!object.has_base) return object;
  object.base_x_m = base.at("x").get<double>();
  object.base_y_m = base.at("y").get<double>();
  object.base_yaw_rad = base.at("yaw").get<double>();
  object.base_sigma_m = base.at("sigma_m").get<double>();
  object.base_sigma_rad = base.at("sigma_rad").get<double>();
  return object;
}

}  // namespace

const char* name_of(Ending ending) {
  switch (ending) {
    case Ending::kDone:
      return "done";
    case Ending::kInterrupted:
      return "interrupted";
    case Ending::kFault:
      return "fault";
    case Ending::kDiskFull:
      return "disk_full";
  }
  return "unknown";
}

std::string format_summary(const RunEnd& end, const RunAnalysis& analysis, const TimingSummary& timing,
                           const std::string& hash) {
  std::uint64_t tracked = end.camera.tracked, lost = end.camera.lost;
  Json objects = Json::array();
  for (const ObjectEnd& object : end.objects) {
    tracked += object.tracked;
    lost += object.lost;
    objects.push_back(object_json(object, analysis_of(analysis, object.id)));
  }
  Json json = {{"version", end.info.version},
               {"source", end.info.source},
               {"mode", end.info.mode},
               {"simd", end.info.simd},
               {"frames", end.frames},
               {"tracked", tracked},
               {"lost", lost},
               {"ended", name_of(end.ending)},
               {"objects", objects},
               {"T_floor_camera", end.has_floor_frame ? matrix(end.T_floor_camera) : Json()},
               {"path", analysis.has_path ? path_json(analysis.path) : Json()},
               {"timing", timing_json(timing)},
               {"memory",
                {{"planned_bytes", end.planned_bytes},
                 {"peak_rss_bytes", end.peak_rss_bytes},
                 {"heap_calls_after_seal", end.heap_calls_after_seal},
                 {"page_faults_after_seal", end.page_faults_after_seal}}},
               {"deadline_misses", end.deadline_misses},
               {"deterministic_hash", hash}};
  if (end.has_camera) {
    const double frames = end.frames > 0 ? static_cast<double>(end.frames) : 1.0;
    json["scan"] = {{"pixels_aligned_mean", end.camera.pixels_aligned / frames},
                    {"bricks_fused_mean", end.camera.bricks_fused / frames}};
  }
  if (end.matching) {
    const MatchingEnd& m = *end.matching;
    json["matching"] = {{"frames", m.frames},
                        {"found", m.found},
                        {"no_keypoints", m.no_keypoints},
                        {"no_matches", m.no_matches},
                        {"no_agreement", m.no_agreement},
                        {"not_verified", m.not_verified}};
  }
  // A source named in bytes that are no UTF-8 must not lose the run its summary.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunSummary parse_summary(std::string_view text, const std::string& name) {
  try {
    const Json json = Json::parse(text);
    RunSummary summary;
    summary.version = json.at("version").get<std::string>();
    summary.source = json.at("source").get<std::string>();
    summary.mode = json.at("mode").get<std::string>();
    summary.simd = json.at("simd").get<std::string>();
    summary.ended = json.at("ended").get<std::string>();
    summary.hash = json.at("deterministic_hash").get<std::string>();
    summary.frames = json.at("frames").get<std::uint64_t>();
    summary.deadline_misses = json.at("deadline_misses").get<std::uint64_t>();
    for (const Json& object : json.at("objects")) summary.objects.push_back(read_object(object));
    return summary;
  } catch (const nlohmann::json::exception& error) {
    throw Failure(ExitCode::kBadInput, name + ": is not a summary of a run (" + error.what() + ")");
  }
}

}  // namespace st
