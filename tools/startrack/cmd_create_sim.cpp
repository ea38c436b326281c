// startrack create-sim: an iRobot Create on a pseudo-terminal.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "algo/core/scalar_math.hpp"
#include "hal/create/sim/create_pty.hpp"
#include "hal/error.hpp"
#include "hal/system/stop_signal.hpp"
#include "tools/startrack/commands.hpp"

namespace st {
namespace {

constexpr double kLongestBraking_s = 1.0;

struct Arguments {
  sim::CreatePtyOptions pty;
  std::string model = "create2";
  std::vector<std::string> events;
  double seconds = 0;
  bool quiet = false;
  int lifeline = -1;
};

void show(const sim::CreateEngine& engine, double t_s) {
  static constexpr const char* kModes[] = {"off", "passive", "safe", "full"};
  const Pose2 pose = engine.body().pose();
  std::fprintf(stderr, "\r%7.1f s  %-7s  x %+.3f m  y %+.3f m  yaw %+.1f deg  v %+.3f m/s  w %+.2f rad/s ",
               t_s, kModes[engine.mode()], pose.x, pose.y, pose.yaw * 180 / kPi, engine.body().v(),
               engine.body().w());
}

int run(Arguments& arguments) {
  arguments.pty.robot.model = arguments.model == "create1" ? RobotModel::kCreate1 : RobotModel::kCreate2;
  for (const std::string& text : arguments.events)
    arguments.pty.events.push_back(sim::parse_world_event(text));
  watch_stop_signals();
  sim::CreatePty pty(arguments.pty);
  std::printf("%s\n", pty.path().c_str());
  std::fflush(stdout);
  const bool live = !arguments.quiet && isatty(STDERR_FILENO) != 0;
  double shown_s = 0, orphaned_s = -1;
  if (arguments.lifeline >= 0) fcntl(arguments.lifeline, F_SETFL, O_NONBLOCK);
  pty.run([&](double t_s) {
    char nothing;
    if (live && t_s >= shown_s + 0.2) show(pty.engine(), shown_s = t_s);
    if (arguments.lifeline >= 0 && orphaned_s < 0 && read(arguments.lifeline, &nothing, 1) == 0)
      orphaned_s = t_s;
    // Its state tells to the last whether it stood.
    const bool left_alone =
        orphaned_s >= 0 && (pty.engine().standing() || t_s > orphaned_s + kLongestBraking_s);
    return stop_signal() != 0 || left_alone || (arguments.seconds > 0 && t_s >= arguments.seconds);
  });
  if (live) std::fputc('\n', stderr);
  return static_cast<int>(stop_signal() != 0 ? ExitCode::kInterrupted : ExitCode::kDone);
}

}  // namespace

void add_create_sim(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("create-sim", "an iRobot Create on a pseudo-terminal, with the real Open Interface");
  command->footer(
      "Prints the path of the pseudo-terminal and runs until Ctrl-C.\n"
      "Example: startrack create-sim --link /tmp/create &\n"
      "         startrack drive --robot /tmp/create --path examples/paths/circle-0.5.toml");
  sim::CreatePtyOptions& pty = arguments->pty;
  command->add_option("--model", arguments->model, "create1 (57600 baud) or create2 (115200 baud)")
      ->check(CLI::IsMember({"create1", "create2"}))
      ->capture_default_str();
  command->add_option("--link", pty.link_path, "symbolic link to make to the pseudo-terminal");
  command->add_option("--state", pty.state_path,
                      "file to publish the robot's true pose in, a thousand times a second");
  command->add_option("--seed", pty.robot.seed, "of slip and line noise")->capture_default_str();
  command
      ->add_option("--slip", pty.robot.errors.slip_noise,
                   "standard deviation of each wheel's slip, 0.02 is 2 %")
      ->check(CLI::Range(0.0, 0.5));
  command
      ->add_option("--left-scale", pty.robot.errors.left_scale, "true size of the left wheel, 1 is nominal")
      ->check(CLI::Range(0.5, 1.5));
  command->add_option("--right-scale", pty.robot.errors.right_scale, "true size of the right wheel")
      ->check(CLI::Range(0.5, 1.5));
  command->add_option("--drop-bytes", pty.robot.noise.drop, "share of the robot's bytes that get lost")
      ->check(CLI::Range(0.0, 1.0));
  command
      ->add_option("--flip-bits", pty.robot.noise.flip,
                   "share of the robot's bytes that arrive with a wrong bit")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option(
      "--at", arguments->events,
      "SECONDS:EVENT, any number: bump, cliff, wheel-drop, charger, unplug, low-battery, reset, text, clear");
  command->add_option("--seconds", arguments->seconds, "end by itself after so long")
      ->check(CLI::PositiveNumber);
  command->add_flag("--quiet", arguments->quiet, "no status line");
  command->add_option("--lifeline", arguments->lifeline)
      ->group("");  // inherited descriptor whose end ends the robot
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace st
