// Real processes for tests: the simulated robot, and programs that get killed.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "hal/create/sim_state_file.hpp"

namespace st::test {

inline void sleep_ms(int ms) {
  const timespec t{ms / 1000, (ms % 1000) * 1000000L};
  nanosleep(&t, nullptr);
}

inline std::int64_t monotonic_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

// Runs the program under test with its output thrown away, in a process group of its own.
inline pid_t start_program(std::vector<std::string> arguments) {
  std::vector<char*> argv = {const_cast<char*>("startrack")};
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  const pid_t pid = fork();
  if (pid != 0) return pid;
  setpgid(0, 0);
  const int nothing = open("/dev/null", O_RDWR);
  for (int fd = 0; fd < 3; ++fd) dup2(nothing, fd);
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

// A folder of its own that goes away with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = std::filesystem::temp_directory_path() / "startrack-test-XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  std::string file(const std::string& name, const std::string& content = {}) const {
    if (!content.empty()) std::ofstream(path_ + "/" + name) << content;
    return path_ + "/" + name;
  }

 private:
  std::string path_;
};

// `startrack create-sim` as a process, and its true state.
class SimulatedRobot {
 public:
  explicit SimulatedRobot(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"create-sim", "--quiet", "--link",
                                          port(),       "--state", folder_.file("state")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    pid_ = start_program(arguments);
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
  }
  bool up() const { return state_ != nullptr; }
  std::string port() const { return folder_.file("robot"); }
  const TemporaryFolder& folder() const { return folder_; }
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
  // After how many milliseconds of its own clock since `since_ns` the robot stood, and stayed so; -1: it has
  // not. To be asked within the second that the ring holds.
  double stood_after_ms(std::int64_t since_ns) const {
    double stood_ms = -1;
    SimStateEntry entry;
    const std::uint64_t end = state_->written(), count = SimStateRing::kEntries - 50;
    for (std::uint64_t i = end > count ? end - count : 0; i < end; ++i) {
      if (!state_->entry(i, entry) || entry.monotonic_ns < since_ns) continue;
      const bool stands = entry.left_mps == 0 && entry.right_mps == 0;
      if (!stands)
        stood_ms = -1;
      else if (stood_ms < 0)
        stood_ms = static_cast<double>(entry.monotonic_ns - since_ns) * 1e-6;
    }
    return stood_ms;
  }

 private:
  TemporaryFolder folder_;
  pid_t pid_ = -1;
  std::unique_ptr<SimStateReader> state_;
};

}  // namespace st::test
