#include "tests/support/provocations.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <sys/socket.h>

#include <atomic>
#include <cstring>
#include <thread>

#include "firmware_like/robot_driver.hpp"
#include "tests/hal/create/processes.hpp"

namespace st::test {
namespace {

constexpr const char* kLongLine = "speed_mps = 0.2\n[[step]]\nline = 50\n";
constexpr double kDriving_mps = 0.19;
constexpr int kPatience_ms = 6000;

pid_t guard_of(pid_t program) {
  std::ifstream children("/proc/" + std::to_string(program) + "/task/" + std::to_string(program) +
                         "/children");
  pid_t child = -1, guard = -1;
  while (children >> child) guard = child;
  return guard;
}

std::vector<std::string> drive(const SimulatedRobot& robot) {
  return {"drive", "--robot", robot.port(), "--path", robot.folder().file("p.toml", kLongLine)};
}

void finish(pid_t program, Outcome& outcome) {
  kill(program, SIGCONT);
  outcome.exit_code = wait_for_exit(program, 100);
  if (outcome.exit_code != -1000) return;
  outcome.exit_code = wait_for_exit(program, 8000);
  if (outcome.exit_code != -1000) return;
  kill(program, SIGKILL);
  wait_for_exit(program, 2000);
}

template <typename Harm>
Outcome measure(const SimulatedRobot& robot, int after_ms, Harm&& harm) {
  Outcome outcome;
  outcome.drove = robot.up() && robot.wait_for_speed(kDriving_mps, 20000);
  if (!outcome.drove) return outcome;
  sleep_ms(after_ms);
  const std::int64_t since_ns = monotonic_ns();
  StandWatch watch(robot.state(), since_ns);
  harm();
  outcome.stood_ms = watch.wait(kPatience_ms);
  outcome.way_m = watch.way_m();
  return outcome;
}

// Something happens to the robot or its cable.
Outcome by_event(const Provocation& what, int after_ms) {
  const SimulatedRobot robot;
  const pid_t program = start_program(drive(robot));
  Outcome outcome = measure(robot, after_ms, [&] { robot.happen(what.event); });
  finish(program, outcome);
  return outcome;
}

// The cable is out for a while: what counts is the time from its return.
Outcome by_cable(const Provocation& what, int after_ms) {
  const SimulatedRobot robot;
  const pid_t program = start_program(drive(robot));
  if (!robot.up() || !robot.wait_for_speed(kDriving_mps, 20000)) {
    kill(program, SIGKILL);
    wait_for_exit(program, 2000);
    return {};
  }
  robot.happen(what.before);
  sleep_ms(50);  // out before anything else happens
  if (what.signal != 0) kill(program, what.signal);
  Outcome outcome = measure(robot, 300 + after_ms, [&] { robot.happen(what.event); });
  finish(program, outcome);
  return outcome;
}

// Something happens to the program.
Outcome by_signal(const Provocation& what, int after_ms) {
  const SimulatedRobot robot;
  const pid_t program = start_program(drive(robot));
  Outcome outcome = measure(robot, after_ms, [&] { kill(-program, what.signal); });
  if (what.signal == SIGSTOP || what.signal == SIGTSTP) {
    kill(program, SIGKILL);  // continued, it would go on with its path, as the rule says
    wait_for_exit(program, 2000);
    return outcome;
  }
  finish(program, outcome);
  return outcome;
}

Outcome by_killed_guard(const Provocation&, int after_ms) {
  const SimulatedRobot robot;
  const pid_t program = start_program(drive(robot));
  Outcome outcome = measure(robot, after_ms, [&] { kill(guard_of(program), SIGKILL); });
  finish(program, outcome);
  return outcome;
}

// At a terminal: armed with Enter, then a key, or the terminal is closed.
Outcome at_terminal(const Provocation& what, int after_ms) {
  const SimulatedRobot robot;
  std::vector<std::string> words = drive(robot);
  words.insert(words.begin(), "startrack");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  // Not forkpty(): other provocations, side by side, must not inherit its end and keep it open.
  int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  char name[64];
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0 ||
      ptsname_r(terminal, name, sizeof name) != 0)
    return {};
  const pid_t program = fork();
  if (program == 0) {
    setsid();
    const int own = open(name, O_RDWR);  // the first one that a session opens is its own
    for (int fd = 0; fd < 3; ++fd) dup2(own, fd);
    execv(STARTRACK_BINARY, argv.data());
    _exit(127);
  }
  const ssize_t armed = write(terminal, "\n", 1);
  // What it shows there must be read, or its next line would wait for room.
  std::atomic<bool> over{false};
  std::thread reader([&] {
    char shown[512];
    fcntl(terminal, F_SETFL, O_NONBLOCK);
    for (; !over.load(); sleep_ms(10))
      while (read(terminal, shown, sizeof shown) > 0) {
      }
  });
  Outcome outcome = measure(robot, after_ms, [&] {
    if (what.event != nullptr && write(terminal, what.event, 1) == 1) return;
    over.store(true);
    reader.join();
    close(terminal);
    terminal = -1;
  });
  outcome.drove = outcome.drove && armed == 1;
  finish(program, outcome);
  over.store(true);
  if (reader.joinable()) reader.join();
  if (terminal >= 0) close(terminal);
  return outcome;
}

// The guard at the robot's end, as a process that stands between.
class RemoteGuardProcess {
 public:
  explicit RemoteGuardProcess(const SimulatedRobot& robot) {
    // A port that was free a moment ago.
    const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof any;
    if (bind(probe, reinterpret_cast<const sockaddr*>(&any), size) == 0)
      getsockname(probe, reinterpret_cast<sockaddr*>(&any), &size);
    close(probe);
    number_ = std::to_string(ntohs(any.sin_port));
    pid_ = start_program({"drive", "--guard", "--robot", robot.port(), "--listen", number_});
  }
  ~RemoteGuardProcess() {
    kill(pid_, SIGCONT);
    kill(pid_, SIGTERM);
    wait_for_exit(pid_, 3000);
  }
  pid_t pid() const { return pid_; }
  // Connects as soon as it listens.
  pid_t start_drive(const SimulatedRobot& robot) const {
    for (int i = 0; i < 400; ++i, sleep_ms(10)) {
      // Meets the robot first: it turns Passive.
      if (robot.now().mode != 0) break;
    }
    sleep_ms(1000);
    return start_program(
        {"drive", "--robot", "tcp:127.0.0.1:" + number_, "--path", robot.folder().file("p.toml", kLongLine)});
  }

 private:
  std::string number_;
  pid_t pid_ = -1;
};

// Over TCP: something happens to the program (before: null), or to the guard at the robot's end.
Outcome over_tcp(const Provocation& what, int after_ms) {
  const SimulatedRobot robot;
  if (!robot.up()) return {};
  const RemoteGuardProcess remote(robot);
  const pid_t program = remote.start_drive(robot);
  const pid_t victim = what.before != nullptr ? remote.pid() : program;
  Outcome outcome = measure(robot, after_ms, [&] { kill(victim, what.signal); });
  if (what.signal == SIGSTOP) {
    kill(program, SIGKILL);
    wait_for_exit(program, 2000);
    return outcome;
  }
  finish(program, outcome);
  return outcome;
}

// The camera's rows, in this process: the loop's side of driving, and a camera that goes blind or stops.
Outcome by_camera(const Provocation& what, int after_ms) {
  const SimulatedRobot robot;
  if (!robot.up()) return {};
  RobotOptions options;
  options.port = robot.port();
  const auto base = open_robot(options);
  Path path;
  path.add_line(50);
  path.plan();
  std::atomic<bool> sees{true}, frames{true}, over{false};
  RobotDriver driver(*base, Steering::kOpenLoop, &path, nullptr, Reaction::kEnd);
  std::thread loop([&] {
    for (; !over.load() && driver.fault() == RobotFault::kNone; sleep_ms(33)) {
      const double now_s = static_cast<double>(monotonic_ns()) * 1e-9;
      if (frames.load()) {
        FixedVector<OdometrySample, 64> odometry;
        driver.listen(odometry);
        DriverView view;
        view.sight = {true, sees.load(), 0.02};
        driver.decide(now_s, view);
        driver.send();
      } else {
        driver.wait_without_frame(now_s);
      }
    }
    driver.stop();
  });
  Outcome outcome =
      measure(robot, after_ms, [&] { (std::strcmp(what.rule, "stale") == 0 ? frames : sees).store(false); });
  over.store(true);
  loop.join();
  outcome.why = name_of(driver.fault());
  outcome.exit_code = driver.fault() == rule_of(RobotFault::kNotSeen).fault ? 3 : 0;
  base->close();
  return outcome;
}

constexpr Provocation kProvocations[] = {
    {"cliff", "cliff sensor", 3, by_event, "cliff", nullptr, 0},
    {"wheel_drop", "wheel drop", 3, by_event, "wheel-drop", nullptr, 0},
    {"bump", "bump", 3, by_event, "bump", nullptr, 0},
    {"left_safe_mode", "charger", 3, by_event, "charger", nullptr, 0},
    {"low_battery", "empty battery", 3, by_event, "low-battery", nullptr, 0},
    {"silent", "robot's bytes get lost", 3, by_event, "mute", nullptr, 0},
    {"silent", "robot resets itself", 3, by_event, "reset", nullptr, 0},
    {"disconnected", "cable pulled, then back", 3, by_cable, "replug", "pull", 0},
    {"disconnected", "cable pulled, program killed, cable back", kAny, by_cable, "replug", "pull", SIGKILL},
    {"disconnected", "plug out at the robot, then back", 3, by_cable, "clear", "unplug", 0},
    {"not_seen", "camera does not see it", 3, by_camera, nullptr, nullptr, 0},
    {"stale", "no more frames", 0, by_camera, nullptr, nullptr, 0},
    {"stalled", "SIGSTOP", kAny, by_signal, nullptr, nullptr, SIGSTOP},
    {"stalled", "Ctrl-Z", kAny, by_signal, nullptr, nullptr, SIGTSTP},
    {"killed", "kill -9", kAny, by_signal, nullptr, nullptr, SIGKILL},
    {"killed", "failed assertion (SIGABRT)", kAny, by_signal, nullptr, nullptr, SIGABRT},
    {"killed", "crash (SIGSEGV)", kAny, by_signal, nullptr, nullptr, SIGSEGV},
    {"killed", "SIGQUIT", kAny, by_signal, nullptr, nullptr, SIGQUIT},
    {"killed", "kill -9, robot over TCP", kAny, over_tcp, nullptr, nullptr, SIGKILL},
    {"stalled", "SIGSTOP, robot over TCP", kAny, over_tcp, nullptr, nullptr, SIGSTOP},
    {"guard_killed", "kill -9 at the robot's end of TCP", 3, over_tcp, nullptr, "remote", SIGKILL},
    {"stalled", "SIGSTOP at the robot's end of TCP", kAny, over_tcp, nullptr, "remote", SIGSTOP},
    {"guard_killed", "kill -9 of the guard", 3, by_killed_guard, nullptr, nullptr, 0},
    {"signal", "Ctrl-C", 130, by_signal, nullptr, nullptr, SIGINT},
    {"signal", "kill", 130, by_signal, nullptr, nullptr, SIGTERM},
    {"signal", "SIGHUP", 130, by_signal, nullptr, nullptr, SIGHUP},
    {"signal", "terminal closed", 130, at_terminal, nullptr, nullptr, 0},
    {"key", "a key", 130, at_terminal, "x", nullptr, 0},
};

}  // namespace

std::span<const Provocation> provocations() { return kProvocations; }

const SafetyRow& row_named(const std::string& name) {
  for (const SafetyRow& row : safety_rules())
    if (name == row.name) return row;
  return safety_rules().front();
}

}  // namespace st::test
