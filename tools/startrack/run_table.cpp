#include "tools/startrack/run_table.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "hal/results/line_file.hpp"
#include "hal/results/run_record.hpp"
#include "tools/report/run_report.hpp"

namespace st {
namespace {

using Json = nlohmann::json;

double milliseconds(const Json& us) { return us.is_number() ? us.get<double>() / 1000 : 0; }
double mebibytes(const Json& bytes) { return bytes.is_number() ? bytes.get<double>() / (1 << 20) : 0; }

void print_path(const Json& path) {
  if (!path.is_object()) return;
  std::printf(
      "  path error            as placed %.1f mm RMSE (largest %.1f), by shape %.1f mm; heading %.2f deg\n",
      path["rmse_as_placed_m"].get<double>() * 1e3, path["max_m"].get<double>() * 1e3,
      path["rmse_shape_m"].get<double>() * 1e3, path["heading_rmse_rad"].get<double>() * 57.29577951);
}

// Preset and driven circle, where the path is one.
void print_circle(const PathComparison& path) {
  if (!path.is_circle) return;
  const CircleFit &preset = path.preset_circle, &driven = path.driven_circle;
  const double off_m = std::hypot(driven.x_m - preset.x_m, driven.y_m - preset.y_m);
  std::printf("  circle, preset        radius %.4f m, centre (%.4f, %.4f) m\n", preset.radius_m, preset.x_m,
              preset.y_m);
  std::printf("  circle, driven        radius %.4f m, centre (%.4f, %.4f) m: %.1f mm off\n", driven.radius_m,
              driven.x_m, driven.y_m, 1e3 * off_m);
}

void print_damage(const RunRecord& run) {
  int damaged = 0, gaps = 0;
  for (const RunRecord::EventRow& event : run.events) {
    damaged += event.event == "damaged" ? 1 : 0;
    gaps += event.event == "gap" ? 1 : 0;
  }
  if (damaged + gaps > 0)
    std::printf("  recording             %d damaged frames skipped, %d gaps (events.csv)\n", damaged, gaps);
}

}  // namespace

void print_run_table(const std::string& run_folder, const std::string& path_file) {
  const Json summary = Json::parse(read_whole_file(run_folder + "/summary.json"));
  std::printf("  frames                %llu\n", summary["frames"].get<unsigned long long>());
  for (const Json& object : summary["objects"])
    std::printf("  object %-3d            tracked %llu, lost %llu frames; path %.2f m\n",
                object["id"].get<int>(), object["tracked"].get<unsigned long long>(),
                object["lost"].get<unsigned long long>(), object["path_length_m"].get<double>());
  if (summary["mode"] == "scan")
    std::printf("  camera                tracked %llu, lost %llu frames\n",
                summary["tracked"].get<unsigned long long>(), summary["lost"].get<unsigned long long>());
  else if (summary["objects"].empty())
    std::printf("  objects               none: nothing moved\n");
  const RunRecord run = read_run(run_folder);
  print_damage(run);
  if (!path_file.empty()) {
    print_circle(study_record(run).path.comparison);
    print_path(summary["path"]);
  }
  const Json& cpu = summary["timing"]["cpu_us"];
  const Json& frame = summary["timing"]["frame_us"];
  std::printf("  frame time, CPU       p50 %.2f  p99 %.2f  max %.2f ms\n", milliseconds(cpu["p50"]),
              milliseconds(cpu["p99"]), milliseconds(cpu["max"]));
  std::printf("  frame time, wall      p50 %.2f  p99 %.2f  max %.2f ms\n", milliseconds(frame["p50"]),
              milliseconds(frame["p99"]), milliseconds(frame["max"]));
  const Json& memory = summary["memory"];
  std::printf(
      "  memory                planned %.1f MiB, peak %.1f MiB; after seal %llu heap calls, %llu page "
      "faults\n",
      mebibytes(memory["planned_bytes"]), mebibytes(memory["peak_rss_bytes"]),
      memory["heap_calls_after_seal"].get<unsigned long long>(),
      memory["page_faults_after_seal"].get<unsigned long long>());
}

}  // namespace st
