// `startrack evaluate RUN or TUM --truth TUM`: errors against ground truth.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "hal/error.hpp"
#include "hal/results/line_file.hpp"
#include "hal/results/run_folder.hpp"
#include "tools/evaluate/evaluate.hpp"
#include "tools/startrack/commands.hpp"

namespace st {
namespace {

namespace fs = std::filesystem;

struct EvaluateOptions {
  std::string estimate, visible;
  std::vector<std::string> truths;
  bool json = false;
};

NamedTrajectory load(const std::string& path) { return {path, parse_tum(read_whole_file(path))}; }

// The trajectories of a run: those of its objects, or of its camera.
std::vector<std::string> trajectories_of(const std::string& run) {
  const bool interrupted = !fs::exists(run + "/summary.json");
  if (interrupted && !fs::exists(run + "/timing.csv"))
    throw Failure(ExitCode::kBadInput, run + ": is no run; give a run folder, or a file in TUM format");
  if (interrupted)
    std::fprintf(
        stderr,
        "startrack: %s: was interrupted (it has no summary.json); what was written up to then is scored\n",
        run.c_str());
  if (const std::string camera = run + "/camera.tum"; fs::exists(camera)) return {camera};
  std::vector<int> ids;
  for (const auto& entry : fs::directory_iterator(run))
    if (const int id = number_in_name(entry.path().filename().string(), "object-", ".tum"); id > 0)
      ids.push_back(id);
  std::ranges::sort(ids);
  std::vector<std::string> paths;
  for (const int id : ids) paths.push_back(run + "/object-" + std::to_string(id) + ".tum");
  return paths;
}

std::string evaluate(const EvaluateOptions& options) {
  const bool is_run = fs::is_directory(options.estimate);
  const std::vector<std::string> paths =
      is_run ? trajectories_of(options.estimate) : std::vector{options.estimate};
  std::vector<NamedTrajectory> truths, estimates;
  for (const std::string& path : options.truths) {
    truths.push_back(load(path));
    if (truths.back().trajectory.poses.empty())
      throw Failure(ExitCode::kBadInput,
                    path + ": holds no pose; a line is `timestamp tx ty tz qx qy qz qw`");
  }
  for (const std::string& path : paths) {
    estimates.push_back(load(path));
    if (!is_run && estimates.back().trajectory.poses.empty())
      throw Failure(ExitCode::kBadInput,
                    path + ": is no TUM trajectory; a line is `timestamp tx ty tz qx qy qz qw`");
  }
  const bool camera = paths.size() == 1 && fs::path(paths[0]).filename() == "camera.tum";
  if (camera) return evaluate_camera(truths[0], estimates[0]);
  Visibility visibility;
  if (!options.visible.empty()) visibility = {read_whole_file(options.visible), options.visible};
  return evaluate_objects(truths, estimates, visibility);
}

}  // namespace

void add_evaluate(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("evaluate", "Score a run or a trajectory against ground truth");
  command->footer("Example:\n  startrack evaluate runs/20240309-080706-lab --truth lab/truth.tum --json");
  auto options = std::make_shared<EvaluateOptions>();
  command->add_option("ESTIMATE", options->estimate, "the folder of a run, or a trajectory in TUM format")
      ->required();
  command->add_option("--truth", options->truths, "ground truth in TUM format; again for each further object")
      ->required();
  command->add_option("--visible", options->visible,
                      "visible.csv of the recording: only frames with the object in sight count");
  command->add_flag("--json", options->json, "print one JSON object (mm, degrees, seconds)");
  command->callback([options, &exit_code] {
    const std::string json = evaluate(*options);
    std::fputs(options->json ? json.c_str() : evaluation_table(json).c_str(), stdout);
    exit_code = 0;
  });
}

}  // namespace st
