// startrack create-sim: an iRobot Create on a pseudo-terminal.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "algo/core/scalar_math.hpp"
#include "hal/create/robot_log_writer.hpp"
#include "hal/create/sim/create_pty.hpp"
#include "hal/error.hpp"
#include "hal/system/realtime.hpp"
#include "hal/system/stop_signal.hpp"
#include "tools/startrack/commands.hpp"
#include "tools/startrack/robot_options.hpp"

namespace st {
namespace {

constexpr double kLongestBraking_s = 1.0;
constexpr int kRobotPriority = 60;  // above the loop, below the guard

struct Arguments {
  sim::CreatePtyOptions pty;
  std::vector<std::string> events;
  std::string truth_path;
  double seconds = 0, json_hz = 0;
  bool quiet = false, events_from_stdin = false;
  int lifeline = -1;
};

constexpr const char* kModes[] = {"off", "passive", "safe", "full"};

void show(const sim::CreateEngine& engine, double t_s) {
  const Pose2 pose = engine.body().pose();
  std::fprintf(stderr, "\r%7.1f s  %-7s  x %+.3f m  y %+.3f m  yaw %+.1f deg  v %+.3f m/s  w %+.2f rad/s ",
               t_s, kModes[engine.mode()], pose.x, pose.y, pose.yaw * 180 / kPi, engine.body().v(),
               engine.body().w());
}

// One line, for programs in any language.
void print_json(const sim::CreatePty& pty, double t_s) {
  const sim::CreateEngine& engine = pty.engine();
  const Pose2 pose = engine.body().pose();
  const auto lights = engine.lights();
  const auto flag = [](bool on) { return on ? "true" : "false"; };
  std::printf(
      "{\"t\": %.3f, \"x\": %.6f, \"y\": %.6f, \"yaw\": %.6f, \"v\": %.6f, \"w\": %.6f, "
      "\"left\": %.6f, \"right\": %.6f, \"wanted_left_mmps\": %d, \"wanted_right_mmps\": %d, "
      "\"mode\": \"%s\", \"asleep\": %s, \"in_script_wait\": %s, \"on_charger\": %s, \"pulled\": %s, "
      "\"leds\": [%d, %d, %d], \"outputs\": %d}\n",
      t_s, pose.x, pose.y, pose.yaw, engine.body().v(), engine.body().w(), engine.body().left_mps(),
      engine.body().right_mps(), engine.wanted_mmps(0), engine.wanted_mmps(1), kModes[engine.mode()],
      flag(engine.asleep()), flag(engine.in_script_wait()), flag(engine.world().on_charger),
      flag(pty.pulled()), lights[0], lights[1], lights[2], engine.outputs());
  std::fflush(stdout);
}

// The true pose as a table, for whoever measures what a tracker or a driver makes of it.
class TruthFile {
 public:
  explicit TruthFile(const std::string& path) {
    if (path.empty()) return;
    file_.reset(std::fopen(path.c_str(), "w"));
    if (!file_)
      throw Failure(ExitCode::kBadInput, "--truth " + path + ": cannot be written; check its folder");
    std::fputs("t,x,y,yaw\n", file_.get());
  }
  void take(const sim::CreateEngine& engine, double t_s) {
    if (!file_ || t_s < due_s_) return;
    due_s_ = t_s + 0.01;
    const Pose2 pose = engine.body().pose();
    std::fprintf(file_.get(), "%.6f,%.6f,%.6f,%.6f\n", host_seconds(), pose.x, pose.y, pose.yaw);
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  double due_s_ = 0;
};

// Events by name, a line each, as they come in.
class StdinEvents {
 public:
  void take(sim::CreatePty& pty) {
    char bytes[256];
    const ssize_t n = read(STDIN_FILENO, bytes, sizeof bytes);
    for (ssize_t i = 0; i < n; ++i) {
      if (bytes[i] != '\n') {
        line_ += bytes[i];
        continue;
      }
      const auto kind = sim::world_event_named(line_);
      if (kind)
        pty.apply(*kind);
      else
        std::fprintf(stderr, "startrack: create-sim: `%s` is no event; events are %s\n", line_.c_str(),
                     sim::world_event_names().c_str());
      line_.clear();
    }
  }

 private:
  std::string line_;
};

int run(Arguments& arguments) {
  for (const std::string& text : arguments.events)
    arguments.pty.events.push_back(sim::parse_world_event(text));
  watch_stop_signals();
  use_realtime_priority(kRobotPriority);  // a robot does not slow down with the load on this computer
  TruthFile truth(arguments.truth_path);
  sim::CreatePty pty(arguments.pty);
  std::printf("%s\n", pty.path().c_str());
  std::fflush(stdout);
  const bool live = !arguments.quiet && isatty(STDERR_FILENO) != 0;
  double shown_s = 0, printed_s = 0, orphaned_s = -1;
  StdinEvents events;
  if (arguments.events_from_stdin) fcntl(STDIN_FILENO, F_SETFL, O_NONBLOCK);
  if (arguments.lifeline >= 0) fcntl(arguments.lifeline, F_SETFL, O_NONBLOCK);
  pty.run([&](double t_s) {
    char nothing;
    if (arguments.events_from_stdin) events.take(pty);
    truth.take(pty.engine(), t_s);
    if (arguments.json_hz > 0 && t_s >= printed_s) print_json(pty, t_s), printed_s += 1 / arguments.json_hz;
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

void add_robot_options(CLI::App& command, Arguments& arguments) {
  sim::CreateOptions& robot = arguments.pty.robot;
  command.add_option("--model", robot.model, "create1 (57600 baud) or create2 (115200 baud)")
      ->transform(robot_models())
      ->type_name("")
      ->default_str("create2");
  command.add_option("--seed", robot.seed, "of slip and line noise")->capture_default_str();
  command
      .add_option("--slip", robot.errors.slip_noise, "standard deviation of each wheel's slip, 0.02 is 2 %")
      ->check(CLI::Range(0.0, 0.5));
  command.add_option("--left-scale", robot.errors.left_scale, "true size of the left wheel, 1 is nominal")
      ->check(CLI::Range(0.5, 1.5));
  command.add_option("--right-scale", robot.errors.right_scale, "true size of the right wheel")
      ->check(CLI::Range(0.5, 1.5));
  command.add_option("--base-scale", robot.base_scale, "true wheel base, 1 is nominal")
      ->check(CLI::Range(0.5, 1.5));
  command.add_option("--speed-step", robot.speed_step_mmps, "its speeds are multiples of so many mm/s")
      ->check(CLI::Range(0.0, 100.0));
  command.add_option("--sleep-after", robot.sleep_after_s, "seconds idle in Passive; 0: never (create2)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      .add_option("--mode-offset", robot.mode_report_offset, "its firmware reports the mode so much too high")
      ->check(CLI::Range(-1, 254));
  command
      .add_flag("--angle-drops-fraction{false}", robot.angle_keeps_fraction,
                "reading distance or angle loses what is below 1 mm or 1 degree")
      ->default_str("off");
}

void add_line_options(CLI::App& command, sim::CreateOptions& robot) {
  const CLI::Range share(0.0, 1.0);
  command.add_option("--baud", robot.start_baud, "speed it starts with, instead of its model's")
      ->check(CLI::IsMember({19200, 57600, 115200}));
  command.add_option("--drop-bytes", robot.noise.drop, "share of the robot's bytes that get lost")
      ->check(share);
  command.add_option("--flip-bits", robot.noise.flip, "share of them that arrive with a wrong bit")
      ->check(share);
  command.add_option("--double-bytes", robot.noise.duplicate, "share of them that arrive twice")
      ->check(share);
  command.add_option("--half-frames", robot.half_frames, "share of the stream's frames that are cut short")
      ->check(share);
  command.add_option("--drop-commands", robot.noise_to_robot.drop, "share of the host's bytes that get lost")
      ->check(share);
  command.add_option("--text-every", robot.text_every_s, "seconds between texts of its own in the stream")
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--checksum-leaves-header", robot.checksum_leaves_header,
                   "the checksum as the Create 1 specification has it, and no real robot");
}

}  // namespace

void add_create_sim(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("create-sim", "an iRobot Create on a pseudo-terminal, with the real Open Interface");
  command->footer(
      "Prints the path of the pseudo-terminal and runs until Ctrl-C.\n"
      "Examples:\n"
      "  startrack create-sim --link /tmp/create &\n"
      "  startrack drive --robot /tmp/create --path examples/paths/circle-0.5.toml\n"
      "  startrack create-sim --model create1 --slip 0.02 --at 5:bump --at 7:clear --json 10\n"
      "  echo cliff | startrack create-sim --stdin\n"
      "Events: " +
      sim::world_event_names() + ".");
  add_robot_options(*command, *arguments);
  add_line_options(*command, arguments->pty.robot);
  command->add_option("--link", arguments->pty.link_path, "symbolic link to make to the pseudo-terminal");
  command->add_option("--state", arguments->pty.state_path,
                      "file to publish the robot's true pose in, a thousand times a second");
  command
      ->add_option("--json", arguments->json_hz, "print its true state so often a second, a JSON line each")
      ->check(CLI::Range(0.1, 1000.0));
  command
      ->add_option(
          "--truth", arguments->truth_path,
          "file for its true pose, a hundred times a second: t,x,y,yaw (host seconds, metres, radians)")
      ->type_name("FILE");
  command->add_option("--at", arguments->events, "SECONDS:EVENT, any number of them");
  command->add_flag("--stdin", arguments->events_from_stdin, "take events from stdin, a name a line");
  command->add_option("--seconds", arguments->seconds, "end by itself after so long")
      ->check(CLI::PositiveNumber);
  command->add_flag("--quiet", arguments->quiet, "no status line");
  command->add_option("--lifeline", arguments->lifeline)
      ->group("");  // inherited descriptor whose end ends the robot
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace st
