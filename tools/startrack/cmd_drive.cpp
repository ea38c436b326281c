// startrack drive: the robot alone, open loop.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "algo/control/dead_reckoning.hpp"
#include "algo/control/follower.hpp"
#include "algo/core/scalar_math.hpp"
#include "firmware_like/path_file.hpp"
#include "firmware_like/safety_supervisor.hpp"
#include "hal/clock.hpp"
#include "hal/create/drive_base.hpp"
#include "hal/create/remote_guard.hpp"
#include "hal/create/sim_child.hpp"
#include "hal/error.hpp"
#include "hal/system/key_stop.hpp"
#include "hal/system/stop_signal.hpp"
#include "tools/startrack/commands.hpp"
#include "tools/startrack/robot_options.hpp"

namespace st {
namespace {

constexpr double kTick_s = 0.02;
// A longer stall than the guard's patience: the robot stood meanwhile, and the path's time with it.
constexpr double kLongestTick_s = 0.25;
constexpr double kSettle_s = 0.1, kLongestSettle_s = 1.0;

struct Arguments {
  RobotOptions robot;
  std::string path, on_bump = "end";
  std::string listen;
  bool rules = false, guard = false;
};

class Drive {
 public:
  Drive(DriveBase& robot, const Path& path, Reaction on_bump)
      : robot_(robot),
        path_(path),
        follower_(path, robot.geometry().wheel_base_m),
        supervisor_(on_bump),
        reckoning_(robot.geometry().wheel_base_m),
        live_(isatty(STDERR_FILENO) != 0) {}

  // Until the path is done, a fault, or a signal.
  void follow() {
    double last_s = now_s();
    WheelSpeeds speeds;
    while (!follower_.done() && stop_signal() == 0) {
      const double t_s = now_s(), passed_s = std::min(t_s - last_s, kLongestTick_s);
      last_s = t_s;
      listen();
      const Reaction reaction = supervisor_.judge(t_s, status_, {}, speeds);
      if (reaction == Reaction::kEnd) break;
      speeds = {};
      if (reaction == Reaction::kHold)
        follower_.hold(passed_s);
      else
        speeds = follower_.step(passed_s, kTick_s);
      robot_.drive(speeds.left_mps, speeds.right_mps);
      show();
      wait_until(t_s + kTick_s);
    }
    fault_ = follower_.done() || stop_signal() != 0 ? RobotFault::kNone : supervisor_.fault();
  }

  // Stops. The robot stands when its wheels report nothing any more: only then is its last pose the end.
  void settle() {
    const double start_s = now_s();
    moved_s_ = start_s;
    const bool heard = fault_ != RobotFault::kSilent && fault_ != RobotFault::kDisconnected;
    do {
      robot_.stop();
      poll(nullptr, 0, static_cast<int>(kTick_s * 1000));
      listen();
    } while (heard && now_s() - moved_s_ < kSettle_s && now_s() - start_s < kLongestSettle_s);
    if (live_) std::fputc('\n', stderr);
  }

  void print_result() const {
    const Pose2 at = reckoning_.pose();
    const PathSample end = follower_.target();
    const double dx = at.x - end.x_m, dy = at.y - end.y_m;
    std::printf(
        "drive: %s after %.1f of %.1f s; by odometry x %.3f y %.3f m yaw %.1f deg; path x %.3f y %.3f m yaw "
        "%.1f deg; "
        "apart %.3f m %.1f deg\n",
        fault_ != RobotFault::kNone ? name_of(fault_)
        : stop_signal() != 0        ? "interrupted"
                                    : "done",
        std::min(follower_.time_s(), path_.duration_s()), path_.duration_s(), at.x, at.y, at.yaw * 180 / kPi,
        end.x_m, end.y_m, end.yaw_rad * 180 / kPi, std::sqrt(dx * dx + dy * dy),
        (at.yaw - end.yaw_rad) * 180 / kPi);
    std::fflush(stdout);
  }

  RobotFault fault() const { return fault_; }

 private:
  static double now_s() { return static_cast<double>(system_clock().monotonic_ns()) * 1e-9; }

  static void wait_until(double t_s) {
    pollfd interrupted{stop_signal_fd(), POLLIN, 0};  // Ctrl-C does not wait for the tick
    const double left_s = t_s - now_s();
    if (left_s > 0) poll(&interrupted, 1, static_cast<int>(std::ceil(left_s * 1000)));
  }

  void listen() {
    odometry_.clear();
    robot_.poll(odometry_, status_);
    for (const OdometrySample& sample : odometry_) {
      reckoning_.add(sample);
      if (sample.left_m != 0 || sample.right_m != 0) moved_s_ = now_s();
    }
  }

  void show() {
    if (!live_ || follower_.time_s() < shown_s_ + 0.1) return;
    shown_s_ = follower_.time_s();
    const Pose2 at = reckoning_.pose();
    const PathSample target = follower_.target();
    const RobotFault held_by = supervisor_.fault();
    std::fprintf(
        stderr,
        "\r%-10s %6.1f / %.1f s  x %+.3f y %+.3f m yaw %+7.1f deg  path x %+.3f y %+.3f yaw %+7.1f  %.1f V ",
        held_by == RobotFault::kNone ? "drives" : name_of(held_by), shown_s_, path_.duration_s(), at.x, at.y,
        at.yaw * 180 / kPi, target.x_m, target.y_m, target.yaw_rad * 180 / kPi, status_.battery_mv * 1e-3);
  }

  DriveBase& robot_;
  const Path& path_;
  OpenLoopFollower follower_;
  SafetySupervisor supervisor_;
  DeadReckoning reckoning_;
  FixedVector<OdometrySample, 64> odometry_;
  RobotStatus status_;
  RobotFault fault_ = RobotFault::kNone;
  double moved_s_ = 0, shown_s_ = 0;
  bool live_;
};

int drive(const Arguments& arguments) {
  const RobotOptions& options = arguments.robot;
  const Path path = load_path(arguments.path);
  watch_stop_signals();
  const std::unique_ptr<DriveBase> robot = open_robot(options);
  if (!is_simulated(options.port) && !arm_at_terminal()) return static_cast<int>(ExitCode::kInterrupted);
  const KeyStop any_key;
  Drive drive(*robot, path, reaction_on_bump(arguments.on_bump));
  drive.follow();
  drive.settle();
  robot->close();
  drive.print_result();
  if (drive.fault() != RobotFault::kNone)
    throw Failure(ExitCode::kDeviceFault, "robot " + options.port + ": " + name_of(drive.fault()) + ": " +
                                              rule_of(drive.fault()).what_to_do);
  return static_cast<int>(stop_signal() != 0 ? ExitCode::kInterrupted : ExitCode::kDone);
}

// The safety rules as a table, for people.
void print_rules() {
  std::printf("%-15s %-52s %-48s %-22s %s\n", "rule", "trigger", "limit", "the run", "stands within");
  for (const SafetyRow& row : safety_rules())
    std::printf("%-15s %-52s %-48s %-22s %d ms\n", row.name, row.trigger, row.limit, name_of(row.reaction),
                row.stands_within_ms);
}

// At the robot's end of a network.
int guard(const Arguments& arguments) {
  if (arguments.robot.port.empty() || arguments.listen.empty())
    throw Failure(ExitCode::kBadInput, "--guard needs --robot PORT and --listen [HOST:]PORT");
  watch_stop_signals();
  RemoteGuard remote(arguments.robot, arguments.listen);
  std::printf("guard: a Create %d at %s; programs reach it at port %d\n",
              remote.model() == RobotModel::kCreate1 ? 1 : 2, arguments.robot.port.c_str(), remote.port());
  std::fflush(stdout);
  if (!remote.serve())
    throw Failure(
        ExitCode::kDeviceFault,
        "robot " + arguments.robot.port + ": the guard process ended; look at the robot, and start it again");
  return static_cast<int>(ExitCode::kInterrupted);
}

int run(const Arguments& arguments) {
  if (arguments.rules) {
    print_rules();
    return 0;
  }
  if (arguments.guard) return guard(arguments);
  if (arguments.robot.port.empty() || arguments.path.empty())
    throw Failure(ExitCode::kBadInput,
                  "drive needs --robot PORT and --path FILE; see startrack drive --help");
  return drive(arguments);
}

}  // namespace

void add_drive(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("drive", "drive the robot along a path by dead reckoning, without a camera");
  command->footer(
      "Ctrl-C, or any key, stops the robot. The last line on stdout says where its wheels think it is.\n"
      "Examples:\n"
      "  startrack drive --robot /dev/ttyUSB0 --path examples/paths/circle-0.5.toml\n"
      "  startrack drive --robot sim --path examples/paths/square-1m.toml\n"
      "  startrack drive --guard --robot /dev/ttyUSB0 --listen 0.0.0.0:7170    # on the robot's own "
      "computer\n"
      "  startrack drive --robot tcp:192.168.1.20:7170 --path examples/paths/circle-0.5.toml\n"
      "  startrack drive --rules        # when it stops, and why");
  command->add_option("--path", arguments->path, "path program: .toml, or .csv way points")
      ->type_name("FILE");
  add_drive_options(*command, arguments->robot, arguments->on_bump, nullptr);
  command->add_option("--model", arguments->robot.model, "create1 or create2; found out when left out")
      ->transform(robot_models())
      ->type_name("");
  command->add_flag("--guard", arguments->guard,
                    "hold --robot for a program elsewhere, and stop it when that falls silent");
  command
      ->add_option("--listen", arguments->listen, "with --guard: where; without HOST for this computer only")
      ->type_name("[HOST:]PORT");
  command->add_flag("--rules", arguments->rules, "print the safety rules, and drive nothing");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace st
