// startrack simulate: a scene as a recording with ground truth.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "firmware_like/path_file.hpp"
#include "hal/error.hpp"
#include "hal/sim/sim_recording.hpp"
#include "tools/startrack/commands.hpp"
#include "tools/startrack/robot_options.hpp"

namespace st {
namespace {

std::atomic<bool> g_stop{false};

struct Options {
  std::string scene, folder, path_file, thing = "1";
  RobotModel robot = RobotModel::kCreate2;
  std::uint64_t seed = 1;
  double seconds = 0, bow_steps = 0;
  bool laptop = false, force = false;
};

// The speeds of a path program, as `run` and `drive` would send them.
std::vector<sim::DriveCommand> commands_of(const Path& path) {
  constexpr double kStep_s = 0.02;
  std::vector<sim::DriveCommand> commands;
  for (double t = 0; t < path.duration_s(); t += kStep_s) {
    const PathSample now = sample(path, t);
    commands.push_back({t, now.v_mps, now.w_rps});
  }
  commands.push_back({path.duration_s(), 0, 0});
  return commands;
}

void prepare_folder(const Options& o) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::create_directories(o.folder, error);
  if (error || !fs::is_directory(o.folder))
    throw Failure(ExitCode::kBadInput,
                  o.folder + ": cannot be made (" + error.message() + "); choose another --out");
  if (fs::is_empty(o.folder)) return;
  if (!o.force)
    throw Failure(
        ExitCode::kBadInput,
        o.folder + ": is not empty; choose another --out, or --force to replace the recording in it");
  if (!fs::exists(o.folder + "/camera.toml"))
    throw Failure(ExitCode::kBadInput, o.folder + ": holds files, but no recording; choose another --out");
  sim::clear_recording(o.folder);
}

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_stop.store(true); };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

int simulate(const Options& o) {
  sim::SceneOptions scene;
  scene.name = o.scene;
  scene.seed = o.seed;
  scene.robot = o.robot;
  scene.laptop = o.laptop;
  scene.thing = sim::parse_thing(o.thing);
  scene.seconds = o.seconds;
  scene.bow_steps = o.bow_steps;
  if (!o.path_file.empty()) scene.path = commands_of(load_path(o.path_file));
  sim::Scene made = sim::make_scene(scene);
  prepare_folder(o);
  catch_signals();
  sim::CameraRig rig(std::move(made));
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const std::uint64_t written =
      sim::write_recording(rig, o.folder, g_stop, [&](std::uint64_t done, std::uint64_t total) {
        if (terminal && (done % 15 == 0 || done == total))
          std::fprintf(stderr, "\r%llu of %llu frames", static_cast<unsigned long long>(done),
                       static_cast<unsigned long long>(total));
      });
  if (terminal) std::fputc('\n', stderr);
  std::printf("recording: %s (%llu depth frames)\n", o.folder.c_str(),
              static_cast<unsigned long long>(written));
  return static_cast<int>(g_stop.load() ? ExitCode::kInterrupted : ExitCode::kDone);
}

}  // namespace

void add_simulate(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("simulate", "Write a synthetic recording with ground truth");
  std::string scenes;
  for (const char* name : sim::scene_names()) scenes += std::string(scenes.empty() ? "" : ", ") + name;
  command->add_option("SCENE", options->scene, "One of: " + scenes)->required();
  command->add_option("--out", options->folder, "Folder of the recording; made, and must be empty")
      ->required();
  command
      ->add_option("--seed", options->seed,
                   "Room, camera, noise and wheel errors; the same seed gives the same bytes")
      ->capture_default_str();
  command->add_option(
      "--path", options->path_file,
      "Preset path of the first robot instead of the scene's own: TOML program or CSV way points");
  command->add_option("--robot-model", options->robot, "create1 or create2")
      ->transform(robot_models())
      ->type_name("")
      ->default_str("create2");
  command->add_flag("--laptop", options->laptop, "An open laptop lies on the first robot");
  command
      ->add_option("--thing", options->thing,
                   "Which made-up thing moves in scene `thing`: a number, or with its relations "
                   "12:print=7,scale=1.12,mirror")
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Length instead of the scene's own")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--bow", options->bow_steps,
                   "A sensor that bows planes: smooth depth error over the image, raw steps at its peak")
      ->check(CLI::Range(0.0, 32.0));
  command->add_flag("--force", options->force, "Replace a recording that stands in the folder");
  command->footer("Example: startrack simulate circle --out /tmp/circle --seed 7 --robot-model create1");
  command->callback([options, &exit_code] { exit_code = simulate(*options); });
}

}  // namespace st
