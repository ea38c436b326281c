#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/evaluate/evaluate.hpp"
#include "tools/evaluate/measures.hpp"

namespace st {
namespace {

using Json = EvaluationJson;

template <typename... Values>
void add_line(std::string& out, const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  out += line;
  out += '\n';
}

void add_statistics(std::string& out, const char* name, const Json& s) {
  if (s.is_object() && s.contains("median"))
    add_line(out, "  %-34s %9.2f %9.2f %9.2f %9.2f", name, s["rmse"].get<double>(), s["median"].get<double>(),
             s["p95"].get<double>(), s["max"].get<double>());
  else if (s.is_object())
    add_line(out, "  %-34s %9.2f %9s %9s %9.2f", name, s["rmse"].get<double>(), "", "",
             s["max"].get<double>());
}

void add_one(std::string& out, const Json& r) {
  out += r.value("gt", "");
  if (r.contains("track")) out += "  beside  " + r["track"].get<std::string>();
  out += '\n';
  add_line(out, "  %llu frames of truth, %llu estimates, %llu matched, coverage %.1f %%",
           r["gt_frames"].get<unsigned long long>(), r.value("estimates", 0ull),
           r["matched"].get<unsigned long long>(), 100 * r["coverage"].get<double>());
  if (r.contains("gaps"))
    add_line(out, "  %llu gaps, the longest %.2f s", r["gaps"]["count"].get<unsigned long long>(),
             r["gaps"]["longest_s"].get<double>());
  if (r.contains("error")) {
    out += "  no score: " + r["error"].get<std::string>() + "\n";
    return;
  }
  add_line(out, "  %-34s %9s %9s %9s %9s", "", "RMSE", "median", "95 %", "largest");
  const bool camera = r.contains("ate");
  const Json& all = camera ? r["ate"] : r;
  add_statistics(out, camera ? "position, aligned (mm)" : "position (mm)", all["trans_mm"]);
  add_statistics(out, camera ? "rotation, aligned (deg)" : "rotation (deg)", all["rot_deg"]);
  if (all.contains("yaw_deg")) add_statistics(out, "yaw (deg)", all["yaw_deg"]);
  if (all.contains("tilt_deg")) add_statistics(out, "tilt (deg)", all["tilt_deg"]);
  if (const char* key = camera ? "first_pose" : "first_b"; r.contains(key)) {
    add_statistics(out, camera ? "position, first pose aligned (mm)" : "position, first second aligned (mm)",
                   r[key]["trans_mm"]);
    add_statistics(out, camera ? "rotation, first pose aligned (deg)" : "rotation, first second (deg)",
                   r[key]["rot_deg"]);
  }
  add_statistics(out, "drift over 1 s (mm)", r["rpe_1s"]["trans_mm"]);
  add_statistics(out, "drift over 1 s (deg)", r["rpe_1s"]["rot_deg"]);
  add_line(out, "  the truth moved %.2f m", r["gt_path_m"].get<double>());
}

}  // namespace

std::string evaluation_table(const std::string& text) {
  const Json json = Json::parse(text);
  std::string out;
  if (!json.contains("objects")) {
    add_one(out, json);
    return out;
  }
  for (const Json& object : json["objects"]) add_one(out, object);
  add_line(out, "changes of track: %llu", json["id_switches"].get<unsigned long long>());
  return out;
}

}  // namespace st
