// Real processes for tests: the simulated robot, and programs that get killed.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "hal/clock.hpp"
#include "hal/create/sim_state_file.hpp"
#include "tests/support/temp_folder.hpp"

namespace st::test {

inline void sleep_ms(int ms) {
  const timespec t{ms / 1000, (ms % 1000) * 1000000L};
  nanosleep(&t, nullptr);
}

inline std::int64_t monotonic_ns() { return system_clock().monotonic_ns(); }

// Runs the program under test with its output thrown away, in a process group of its own. `in`: its stdin.
inline pid_t start_program(std::vector<std::string> arguments, int in = -1) {
  std::vector<char*> argv = {const_cast<char*>("startrack")};
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  const pid_t pid = fork();
  if (pid != 0) return pid;
  setpgid(0, 0);
  // A test that itself was started in the background has these ignored, and would hand that on.
  for (const int number : {SIGINT, SIGQUIT, SIGHUP}) signal(number, SIG_DFL);
  const int nothing = open("/dev/null", O_RDWR);
  for (int fd = 0; fd < 3; ++fd) dup2(fd == 0 && in >= 0 ? in : nothing, fd);
  execv(STARTRACK_BINARY, argv.data());
  _exit(127);
}

// Exit code, or -signal; -1000 when it did not end in time.
inline int wait_for_exit(pid_t pid, int timeout_ms) {
  for (int waited = 0; waited <= timeout_ms; waited += 10, sleep_ms(10)) {
    int status = 0;
    if (waitpid(pid, &status, WNOHANG) == pid)
      return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  return -1000;
}

// `startrack create-sim` as a process, and its true state.
class SimulatedRobot {
 public:
  explicit SimulatedRobot(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"create-sim",          "--quiet", "--link", port(), "--state",
                                          folder_.file("state"), "--stdin"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    events_ = ends[1];
    pid_ = start_program(arguments, ends[0]);
    close(ends[0]);
    for (int i = 0; i < 500 && !state_; ++i) {
      sleep_ms(10);
      try {
        if (std::filesystem::exists(port())) state_ = std::make_unique<SimStateReader>(folder_.file("state"));
      } catch (const std::exception&) {
      }
    }
  }
  ~SimulatedRobot() {
    kill(pid_, SIGTERM);
    if (wait_for_exit(pid_, 5000) == -1000) kill(pid_, SIGKILL);
    close(events_);
  }
  SimulatedRobot(const SimulatedRobot&) = delete;
  SimulatedRobot& operator=(const SimulatedRobot&) = delete;

  // An event of create-sim, by name.
  void happen(const std::string& event) const {
    const std::string line = event + "\n";
    if (write(events_, line.data(), line.size()) < 0) kill(pid_, SIGTERM);
  }
  bool up() const { return state_ != nullptr; }
  std::string port() const { return folder_.file("robot"); }
  const TempFolder& folder() const { return folder_; }
  SimStateEntry now() const {
    SimStateEntry entry;
    if (state_) state_->newest(entry);
    return entry;
  }
  bool wait_for_speed(double v_mps, int timeout_ms = 10000) const {
    for (int waited = 0; waited < timeout_ms; waited += 5, sleep_ms(5))
      if (now().v_mps >= v_mps) return true;
    return false;
  }
  const SimStateReader& state() const { return *state_; }

 private:
  TempFolder folder_;
  pid_t pid_ = -1;
  int events_ = -1;
  std::unique_ptr<SimStateReader> state_;
};

// When a simulated robot came to stand, by its own clock, and how far it went until then.
class StandWatch {
 public:
  StandWatch(const SimStateReader& state, std::int64_t since_ns)
      : state_(state), since_ns_(since_ns), next_(state.written() > 20 ? state.written() - 20 : 0) {}

  // To be called more often than the state's ring goes round (a second).
  void look() {
    SimStateEntry entry;
    for (const std::uint64_t end = state_.written(); next_ < end; ++next_) {
      if (!state_.entry(next_, entry) || entry.monotonic_ns < since_ns_) continue;
      way_m_ += std::fabs(entry.v_mps) * 1e-3;
      const bool stands = entry.left_mps == 0 && entry.right_mps == 0;
      if (!stands) stood_ns_ = -1;
      if (stands && stood_ns_ < 0) stood_ns_ = entry.monotonic_ns;
      seen_ns_ = entry.monotonic_ns;
    }
  }
  // Until it has stood for a while, or the time is up. Milliseconds from the start until it stood for good;
  // -1: it did not.
  double wait(int timeout_ms, int standing_ms = 300) {
    for (int waited = 0; waited < timeout_ms; waited += 5, sleep_ms(5)) {
      look();
      if (stood_ns_ >= 0 && seen_ns_ - stood_ns_ > standing_ms * 1'000'000LL) break;
    }
    return stood_ns_ < 0 ? -1.0 : static_cast<double>(stood_ns_ - since_ns_) * 1e-6;
  }
  double way_m() const { return way_m_; }

 private:
  const SimStateReader& state_;
  std::int64_t since_ns_;
  std::uint64_t next_;
  std::int64_t stood_ns_ = -1, seen_ns_ = 0;
  double way_m_ = 0;
};

}  // namespace st::test
