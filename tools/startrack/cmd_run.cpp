// startrack run: the live loop.
#include <memory>

#include "tools/startrack/robot_options.hpp"
#include "tools/startrack/session_command.hpp"

namespace st {

void add_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SessionOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Track what moves before the Kinect, and drive the robot along a path");
  command->footer(
      "Examples:\n"
      "  startrack run --source kinect --seconds 60\n"
      "  startrack run --source kinect --robot /dev/ttyUSB0 --path examples/paths/circle-0.5.toml\n"
      "  startrack run --source sim:lab --robot sim --path examples/paths/circle-0.5.toml\n"
      "  startrack run --source sim:lab --robot sim --serve 7171     # and then "
      "tools/client/hold_circle.py\n"
      "  startrack run --source sim:lab --robot sim:right-scale=1.03,slip=0.02 --loop closed --path "
      "examples/paths/circle-0.5.toml");
  command
      ->add_option("--source", options->source.spec,
                   "kinect[:INDEX or SERIAL], sim:SCENE, or a recording's folder")
      ->required()
      ->type_name("SRC");
  auto on_bump = std::make_shared<std::string>("end");
  add_drive_options(*command, options->robot, *on_bump, &options->loop.camera_lag_s);
  command
      ->add_option_function<std::uint64_t>(
          "--seed",
          [options](const std::uint64_t& seed) { options->source.seed = options->robot.seed = seed; },
          "of the simulated room and robot")
      ->default_str("1");
  command
      ->add_option_function<std::string>(
          "--loop", [options](const std::string& loop) { options->closed_loop = loop == "closed"; },
          "how the path is driven: open, by dead reckoning, or closed, on the pose at which the robot is "
          "seen")
      ->check(CLI::IsMember({"open", "closed"}))
      ->default_str("open");
  command
      ->add_option("--record", options->record,
                   "new folder for a recording of the run: the camera's frames and the robot's bytes")
      ->type_name("DIR");
  command
      ->add_option("--serve", options->serve,
                   "poses as JSON lines for programs that connect here, and with --robot but without --path "
                   "they drive it; without HOST for this computer only, port 0: any that is free")
      ->type_name("[HOST:]PORT");
  add_session_options(*command, *options);
  command->callback([options, on_bump, &exit_code] {
    options->on_bump = reaction_on_bump(*on_bump);
    if (!options->robot.port.empty() && options->loop.mode == Mode::kScan)
      throw Failure(ExitCode::kBadInput,
                    "--mode scan moves the camera by hand and watches no robot: leave out --robot " +
                        options->robot.port + ", or --mode scan");
    if (!options->robot.port.empty() && options->path_file.empty() && options->serve.empty())
      throw Failure(ExitCode::kBadInput, "--robot " + options->robot.port +
                                             " needs --path FILE, or --serve PORT for a program that drives "
                                             "it: what shall it do?");
    if (options->closed_loop && (options->robot.port.empty() || options->path_file.empty()))
      throw Failure(ExitCode::kBadInput,
                    "--loop closed needs --robot PORT and --path FILE: what is to follow what?");
    const std::string& source = options->source.spec;
    if (!options->robot.port.empty() && !source.starts_with("kinect") && !source.starts_with("sim:"))
      throw Failure(ExitCode::kBadInput,
                    "--robot " + options->robot.port +
                        " needs a camera that sees it now: --source kinect or sim:SCENE; "
                        "over a recording use startrack replay --path");
    exit_code = run_and_report(*options);
  });
}

}  // namespace st
