#include "hal/create/sim_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "hal/error.hpp"

namespace st {
namespace {

constexpr int kStart_ms = 10000;
constexpr int kEnd_ms = 2000;

[[noreturn]] void cannot(const std::string& what) {
  throw Failure(ExitCode::kDeviceFault, "simulated robot: " + what);
}

// `sim:slip=0.02,mode-offset=1` -> --slip=0.02 --mode-offset=1
void add_switches(const std::string& port, std::vector<std::string>& arguments) {
  for (std::size_t at = port.find(':'); at != std::string::npos; at = port.find(',', at + 1)) {
    const std::size_t end = std::min(port.find(',', at + 1), port.size());
    if (end > at + 1) arguments.push_back("--" + port.substr(at + 1, end - at - 1));
  }
}

// Only system calls: it runs between fork and exec.
[[noreturn]] void become_simulator(const char* program, char* const* arguments, int state, int lifeline,
                                   int out) {
  setsid();  // Ctrl-C and Ctrl-Z are for the program, not for its robot
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(open("/dev/null", O_RDONLY), 0);
  dup2(out, 1);
  fcntl(state, F_SETFD, 0);
  fcntl(lifeline, F_SETFD, 0);
  execv(program, arguments);
  _exit(127);
}

}  // namespace

bool wait_for_child(pid_t pid, int timeout_ms) {
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
  if (handle >= 0) {
    pollfd ended{handle, POLLIN, 0};
    while (poll(&ended, 1, timeout_ms) < 0 && errno == EINTR) {
    }
    close(handle);
  }
  int status = 0;
  const pid_t reaped = waitpid(pid, &status, WNOHANG);
  return reaped == pid || (reaped < 0 && errno == ECHILD);
}

bool is_simulated(const std::string& port) { return port == "sim" || port.starts_with("sim:"); }

SimChild::SimChild(const std::string& port, RobotModel model, std::uint64_t seed) {
  const char* named = std::getenv("STARTRACK_BINARY");
  const std::string program = named != nullptr ? named : "/proc/self/exe";
  int life[2], out[2];
  state_ = memfd_create("create-sim-state", MFD_CLOEXEC);
  if (state_ < 0 || pipe2(life, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0) cannot(std::strerror(errno));
  lifeline_ = life[1];
  std::vector<std::string> arguments = {"startrack",
                                        "create-sim",
                                        "--quiet",
                                        "--model",
                                        model == RobotModel::kCreate1 ? "create1" : "create2",
                                        "--seed",
                                        std::to_string(seed),
                                        "--state",
                                        "/proc/self/fd/" + std::to_string(state_),
                                        "--lifeline",
                                        std::to_string(life[0])};
  add_switches(port, arguments);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) become_simulator(program.c_str(), argv.data(), state_, life[0], out[1]);
  const int fork_error = errno;
  close(life[0]);
  close(out[1]);
  if (pid_ > 0) read_port(out[0]);
  close(out[0]);
  if (!port_.empty()) return;
  close(lifeline_);
  close(state_);
  if (pid_ < 0) cannot(std::string("cannot start a process: ") + std::strerror(fork_error));
  wait_for_child(pid_, kEnd_ms);
  cannot("`" + program + " create-sim` did not come up as `" + port + "`; run it by hand to see why");
}

void SimChild::read_port(int from) {
  pollfd ready{from, POLLIN, 0};
  std::string line;
  while (line.empty() || line.back() != '\n') {
    char c;
    const int events = poll(&ready, 1, kStart_ms);
    if (events < 0 && errno == EINTR) continue;
    if (events <= 0 || read(from, &c, 1) != 1) return;
    line += c;
  }
  line.pop_back();
  port_ = line;
}

SimChild::~SimChild() {
  close(lifeline_);
  close(state_);
  if (!wait_for_child(pid_, kEnd_ms)) kill(pid_, SIGTERM);
}

std::string SimChild::state_path() const { return "/proc/self/fd/" + std::to_string(state_); }

}  // namespace st
