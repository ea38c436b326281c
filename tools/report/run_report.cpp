#include "tools/report/run_report.hpp"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "algo/core/scalar_math.hpp"
#include "hal/results/line_file.hpp"
#include "hal/results/text_format.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/svg_chart.hpp"

namespace st {
namespace {

constexpr const char* kStyle = R"(
:root{--ink:#1c2530;--soft:#5d6b7a;--rule:#d9dfe5;--faint:#f4f6f8;--preset:#2f6db5;--actual:#d9541e;--shape:#2c9a6b;--other:#7d5ba6}
*{box-sizing:border-box}
body{margin:0;background:#fff;color:var(--ink);font:15px/1.5 "Inter","Source Sans 3","Segoe UI","Helvetica Neue",Arial,"DejaVu Sans",sans-serif}
main{max-width:820px;margin:0 auto;padding:36px 28px 48px}
header{border-bottom:2px solid var(--ink);padding-bottom:14px;margin-bottom:20px}
h1{font-size:28px;line-height:1.15;margin:0 0 4px;letter-spacing:-.01em}
h2{font-size:18px;margin:34px 0 10px;padding-bottom:4px;border-bottom:1px solid var(--rule)}
h3{font-size:15px;margin:18px 0 6px}
.sub{color:var(--soft)}
.warning{background:#fff4e5;border-left:4px solid #e08a00;padding:9px 14px;margin:14px 0}
dl.facts{display:grid;grid-template-columns:repeat(4,1fr);gap:10px 18px;margin:0}
dl.facts div{border-top:1px solid var(--rule);padding-top:5px}
dt{color:var(--soft);font-size:12px}
dd{margin:0;font-weight:600;font-variant-numeric:tabular-nums;overflow-wrap:anywhere}
.lead{display:grid;grid-template-columns:repeat(4,1fr);gap:12px;margin:22px 0 6px}
.lead div{background:var(--faint);border-radius:6px;padding:11px 14px}
.lead b{display:block;font-size:23px;line-height:1.2;font-variant-numeric:tabular-nums}
.lead span{color:var(--soft);font-size:12.5px}
figure{margin:10px 0 18px;break-inside:avoid}
figcaption,.note,.caption{color:var(--soft);font-size:13px}
svg{display:block;width:100%;height:auto}
svg text{font-family:inherit;fill:var(--ink)}
.tick{font-size:11.5px;fill:var(--soft)!important;font-variant-numeric:tabular-nums}
.label{font-size:12.5px}.legend{font-size:12px}
.mid{text-anchor:middle}.end{text-anchor:end}
path.grid{stroke:#e3e8ed;stroke-width:1;fill:none}
path.zero{stroke:#9aa7b4;stroke-width:1;fill:none}
path.line{fill:none;stroke-width:1.8;stroke-linejoin:round;stroke-linecap:round;stroke:var(--soft)}
path.line.preset{stroke:var(--preset);stroke-width:2.6;stroke-dasharray:7 5;stroke-linecap:butt}
path.line.actual{stroke:var(--actual)}
path.line.shape{stroke:var(--shape);stroke-width:1.3}
path.line.other{stroke:var(--other)}
.mark circle,.mark rect{fill:#fff;stroke-width:2.2}
.mark path{fill:none;stroke-width:2.2;stroke-linejoin:round}
.mark.preset *{stroke:var(--preset)}.mark.actual *{stroke:var(--actual)}.mark.other *{stroke:var(--other)}
rect.band{fill:#e9f4ee}
rect.bar{fill:#5b87ad}
.good{fill:#3d9970;background:#3d9970}.predicted{fill:#f0b429;background:#f0b429}.poor{fill:#e5793a;background:#e5793a}.lost{fill:#c9ced4;background:#c9ced4}
.key{display:inline-block;width:11px;height:11px;border-radius:2px;margin:0 5px 0 10px}
table{border-collapse:collapse;margin:8px 0 14px;width:100%;font-variant-numeric:tabular-nums;break-inside:avoid}
th,td{padding:4px 10px;border-bottom:1px solid var(--rule);text-align:right;font-size:14px}
th{font-weight:500}thead th{color:var(--soft);font-size:12.5px;border-bottom:1.5px solid #aab4be}
th:first-child,td:first-child{text-align:left;padding-left:0}
table.errors td{font-weight:600}
table.events th,td.words{text-align:left}
tr.total th,tr.total td{font-weight:700}
.views{display:grid;grid-template-columns:repeat(3,1fr);gap:14px;break-inside:avoid}
.view{background:var(--faint);border-radius:6px;padding:10px;text-align:center}
.view img{width:100%;height:auto;display:block}
footer{margin-top:36px;padding-top:10px;border-top:1px solid var(--rule);color:var(--soft);font-size:12.5px}
@media (max-width:640px){.lead,dl.facts{grid-template-columns:repeat(2,1fr)}.views{grid-template-columns:1fr}}
@page{size:A4;margin:14mm}
@media print{body{font-size:12.5px;-webkit-print-color-adjust:exact;print-color-adjust:exact}main{max-width:none;padding:0}h2{margin-top:22px;break-after:avoid}.lead,.facts{break-inside:avoid}}
)";

std::string run_name(const RunRecord& run) {
  std::filesystem::path path(run.folder);
  if (!path.has_filename()) path = path.parent_path();
  const std::string name = std::filesystem::absolute(path).lexically_normal().filename().string();
  return name.empty() ? run.folder : name;
}

std::string fact(const std::string& name, const std::string& value) {
  return value.empty() ? "" : "<div><dt>" + name + "</dt><dd>" + escape_html(value) + "</dd></div>";
}

std::string facts(const ReportInput& input) {
  const RunRecord& run = input.run;
  const RunRecord::Column* t = run.timing_column("t");
  std::string out = "<dl class=\"facts\">";
  if (run.summary) out += fact("source", run.summary->source) + fact("mode", run.summary->mode);
  out += fact("frames", std::to_string(run.summary ? run.summary->frames : t->values.size()));
  out += fact("length", number(input.t1_s - input.t0_s, 1) + " s");
  out += fact("objects", std::to_string(run.objects.size()));
  if (run.summary) {
    std::uint64_t tracked = 0, lost = 0;
    for (const RunSummary::Object& object : run.summary->objects)
      tracked += object.tracked, lost += object.lost;
    out += fact("frames tracked / lost", std::to_string(tracked) + " / " + std::to_string(lost));
    out += fact("deadlines missed", std::to_string(run.summary->deadline_misses));
    out += fact("startrack", run.summary->version + ", " + run.summary->simd);
  }
  return out + "</dl>";
}

// The few figures that people look for first.
std::string lead(const RunStudy& study) {
  if (study.path.object == 0) return {};
  const PathComparison& c = study.path.comparison;
  const auto card = [](const std::string& value, const std::string& name) {
    return "<div><b>" + value + "</b><span>" + name + "</span></div>";
  };
  std::string out = "<div class=\"lead\">" +
                    card(number(c.as_placed.rmse_m * 1e3, 1) + " mm", "from the path as placed, RMS") +
                    card(number(c.shape.rmse_m * 1e3, 1) + " mm", "from its shape, RMS");
  if (c.is_circle)
    out += card(number(c.driven_circle.radius_m, 4) + " m",
                "radius driven; preset " + number(c.preset_circle.radius_m, 4) + " m");
  else
    out += card(number(c.as_placed.max_m * 1e3, 0) + " mm", "largest distance as placed");
  return out +
         card(number(c.as_placed.in_band * 100, 0) + " %",
              "of the time within " + number(kPathBandM * 100, 0) + " cm") +
         "</div>";
}

std::string headline(const ReportInput& input) {
  const bool with_path = input.study.path.object != 0;
  std::string out = "<header><h1>";
  out += with_path ? "Preset and actual path" : "What was tracked";
  out += "</h1><div class=\"sub\">Run " + escape_html(run_name(input.run)) + "</div></header>";
  if (!input.run.summary)
    out +=
        "<p class=\"warning\"><b>This run was interrupted.</b> It has no summary; what follows is what was "
        "written up to that "
        "moment.</p>";
  else if (input.run.summary->ended != "done")
    out += "<p class=\"warning\">This run did not come to its end: " + escape_html(input.run.summary->ended) +
           ".</p>";
  if (input.run.objects.empty() && input.run.camera.empty())
    out += "<p class=\"warning\">Nothing was seen to move, so nothing was tracked.</p>";
  else if (!input.run.path.empty() && !with_path)
    out += "<p class=\"warning\">A path was given, but nothing that drove it could be told apart.</p>";
  return out;
}

// Who drove the path: what answered to the start motion; else the base that path.csv was laid from, whose
// first pose is nearest to its start.
PathDriver driver_of(const RunRecord& run, const RunStudy& study) {
  for (const RunRecord::EventRow& event : run.events)
    if (event.event == name_of(EventKind::kSteeringObject)) return {event.object, event.t_s};
  int best = 0;
  double nearest = 0;
  for (const ObjectStudy& object : study.objects) {
    if (!object.has_base) continue;
    const Pose2 first = first_pose(object.driven);
    const double d = std::hypot(first.x - run.path.front()[1], first.y - run.path.front()[2]);
    if (best == 0 || d < nearest) best = object.id, nearest = d;
  }
  return {best, -1};
}

}  // namespace

RunStudy study_record(const RunRecord& run) {
  std::vector<ObjectTrack> tracks;
  for (const RunRecord::Object& object : run.objects)
    tracks.push_back({object.id, object.rows, object.mesh.vertices});
  const RunStudy alone = study_run(tracks, {}, {});
  if (run.path.empty()) return alone;
  // Back from the floor into the frame of the path's start.
  const std::array<double, 6>& start = run.path.front();
  const Pose2 T_path_floor = inverse({start[1], start[2], start[3]});
  std::vector<PathSample> path;
  for (const std::array<double, 6>& row : run.path) {
    const Pose2 p = compose(T_path_floor, {row[1], row[2], row[3]});
    const double yaw = path.empty() ? p.yaw : path.back().yaw_rad + wrap_angle(p.yaw - path.back().yaw_rad);
    path.push_back({row[0] - start[0], p.x, p.y, yaw, row[4], row[5]});
  }
  return study_run(tracks, path, driver_of(run, alone));
}

std::string number(double value, int decimals) {
  std::string out;
  append_fixed(out, value, decimals);
  return out;
}

std::string figure(const std::string& drawing, const std::string& caption) {
  return "<figure>" + drawing + "<figcaption>" + caption + "</figcaption></figure>";
}

std::string section(const std::string& title, const std::string& content) {
  return content.empty() ? "" : "<section><h2>" + title + "</h2>" + content + "</section>";
}

std::string data_block(const ReportInput& input) {
  nlohmann::ordered_json json;
  json["run"] = run_name(input.run);
  json["interrupted"] = !input.run.summary.has_value();
  const PathStudy& path = input.study.path;
  if (path.object != 0) {
    const RunAnalysis analysis = to_analysis(input.study);
    json["path"] = {{"object", path.object},
                    {"rmse_as_placed_m", analysis.path.rmse_as_placed_m},
                    {"rmse_shape_m", analysis.path.rmse_shape_m},
                    {"max_m", analysis.path.max_m},
                    {"heading_rmse_rad", analysis.path.heading_rmse_rad},
                    {"in_band", analysis.path.in_band}};
    if (analysis.path.is_circle) json["path"]["radius_m"] = analysis.path.radius_m;
    json["preset_t_x_y_yaw_v_w"] = analysis.path.rows;
  }
  for (const ObjectStudy& object : input.study.objects) {
    if (!object.has_base) continue;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    constexpr std::size_t kMost = 4000;
    for (std::size_t i = 0; i < object.driven.size(); i += object.driven.size() / kMost + 1) {
      const PlanarSample& s = object.driven[i];
      rows.push_back({s.t_s, s.x_m, s.y_m, s.yaw_rad});
    }
    json["base_" + std::to_string(object.id) + "_t_x_y_yaw"] = rows;
  }
  // "</script" must not occur in it: no string here comes with a '<' but the run's name, and that is escaped.
  std::string text = json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
    text.replace(at, 1, "\\u003c");
  return "<script type=\"application/json\" id=\"data\">" + text + "</script>";
}

std::string make_report(const RunRecord& run) {
  const RunStudy study = study_record(run);
  const RunRecord::Column* t = run.timing_column("t");
  const bool any = t != nullptr && !t->values.empty();
  const ReportInput input{run, study, any ? t->values.front() : 0, any ? t->values.back() : 0};
  return "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width\"><title>" +
         escape_html(run_name(run)) + "</title><style>" + kStyle + "</style></head><body><main>" +
         headline(input) + facts(input) + lead(study) + path_section(input) + motion_section(input) +
         model_section(input) + scene_section(input) + loop_section(input) + event_section(input) +
         "<footer>Made by startrack from the files in the run's folder. Lengths in metres, angles "
         "counter-clockwise; "
         "the floor frame has z up and x along the camera's axis.</footer></main>" +
         data_block(input) + "</body></html>\n";
}

std::string write_report(const std::string& run_folder) {
  const std::string path = run_folder + "/report.html";
  write_whole_file(path, make_report(read_run(run_folder)));
  return path;
}

}  // namespace st
