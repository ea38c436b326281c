// startrack drive: the robot alone, open loop.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "algo/control/dead_reckoning.hpp"
#include "algo/control/follower.hpp"
#include "firmware_like/path_file.hpp"
#include "hal/clock.hpp"
#include "hal/create/drive_base.hpp"
#include "hal/error.hpp"
#include "hal/system/stop_signal.hpp"
#include "tools/startrack/commands.hpp"

namespace st {
namespace {

constexpr double kTick_s = 0.02;
// A longer stall than the guard's patience: the robot stood meanwhile, and the path's time with it.
constexpr double kLongestTick_s = 0.25;
constexpr double kSettle_s = 0.1, kLongestSettle_s = 1.0;

struct Arguments {
  RobotOptions robot;
  std::string model, path;
};

const char* advice(RobotFault fault) {
  switch (fault) {
    case RobotFault::kSilent:
      return "nothing comes from it; stop it by hand if it moves, then check its battery and cable";
    case RobotFault::kDisconnected:
      return "the port went away; plug the cable in again, and stop the robot by hand if it moves";
    case RobotFault::kBump:
      return "it ran into something; clear its way";
    case RobotFault::kCliff:
      return "it stands at an edge; put it back on the floor";
    case RobotFault::kWheelDrop:
      return "a wheel hangs in the air; put it back on the floor";
    case RobotFault::kLeftSafeMode:
      return "it left Safe mode by itself; take it off the charger and start again";
    default:
      return "";
  }
}

class Drive {
 public:
  Drive(DriveBase& robot, const Path& path)
      : robot_(robot),
        path_(path),
        follower_(path, robot.geometry().wheel_base_m),
        reckoning_(robot.geometry().wheel_base_m),
        live_(isatty(STDERR_FILENO) != 0) {}

  // Until the path is done, a fault, or a signal.
  void follow() {
    double last_s = now_s();
    while (!follower_.done() && !ended()) {
      const double t_s = now_s();
      const WheelSpeeds speeds = follower_.step(std::min(t_s - last_s, kLongestTick_s), kTick_s);
      last_s = t_s;
      robot_.drive(speeds.left_mps, speeds.right_mps);
      listen();
      show();
      wait_until(t_s + kTick_s);
    }
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
  bool ended() const { return fault_ != RobotFault::kNone || stop_signal() != 0; }

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
    if (status_.fault == RobotFault::kLowBattery)
      warn_of_battery();
    else if (fault_ == RobotFault::kNone)
      fault_ = status_.fault;
  }

  void warn_of_battery() {
    if (!battery_warned_)
      std::fprintf(stderr, "startrack: the robot's battery is low (%.1f V); charge it soon\n",
                   status_.battery_mv * 1e-3);
    battery_warned_ = true;
  }

  void show() {
    if (!live_ || follower_.time_s() < shown_s_ + 0.1) return;
    shown_s_ = follower_.time_s();
    const Pose2 at = reckoning_.pose();
    const PathSample target = follower_.target();
    std::fprintf(
        stderr,
        "\r%6.1f / %.1f s  x %+.3f y %+.3f m yaw %+7.1f deg  path x %+.3f y %+.3f yaw %+7.1f  %.1f V ",
        shown_s_, path_.duration_s(), at.x, at.y, at.yaw * 180 / kPi, target.x_m, target.y_m,
        target.yaw_rad * 180 / kPi, status_.battery_mv * 1e-3);
  }

  DriveBase& robot_;
  const Path& path_;
  OpenLoopFollower follower_;
  DeadReckoning reckoning_;
  FixedVector<OdometrySample, 64> odometry_;
  RobotStatus status_;
  RobotFault fault_ = RobotFault::kNone;
  double moved_s_ = 0, shown_s_ = 0;
  bool live_, battery_warned_ = false;
};

int run(const Arguments& arguments) {
  RobotOptions options = arguments.robot;
  options.model_given = !arguments.model.empty();
  if (arguments.model == "create1") options.model = RobotModel::kCreate1;
  const Path path = load_path(arguments.path);
  watch_stop_signals();
  const std::unique_ptr<DriveBase> robot = open_robot(options);
  Drive drive(*robot, path);
  drive.follow();
  drive.settle();
  robot->close();
  drive.print_result();
  if (drive.fault() != RobotFault::kNone)
    throw Failure(ExitCode::kDeviceFault,
                  "robot " + options.port + ": " + name_of(drive.fault()) + ": " + advice(drive.fault()));
  return static_cast<int>(stop_signal() != 0 ? ExitCode::kInterrupted : ExitCode::kDone);
}

}  // namespace

void add_drive(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("drive", "drive the robot along a path by dead reckoning, without a camera");
  command->footer(
      "Ctrl-C stops the robot. The last line on stdout says where its wheels think it is.\n"
      "Example: startrack drive --robot /dev/ttyUSB0 --path examples/paths/circle-0.5.toml\n"
      "         startrack drive --robot sim --path examples/paths/square-1m.toml");
  command->add_option("--robot", arguments->robot.port, "a serial device such as /dev/ttyUSB0, or sim")
      ->required();
  command->add_option("--path", arguments->path, "path program: .toml, or .csv way points")->required();
  command->add_option("--model", arguments->model, "create1 or create2; found out when left out")
      ->check(CLI::IsMember({"create1", "create2"}));
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace st
