#include "hal/create/sim/create_pty.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "hal/create/sim_state_file.hpp"
#include "hal/error.hpp"

namespace st::sim {
namespace {

constexpr std::int64_t kSlice_ns = 1'000'000;
constexpr std::int64_t kLongestCatchUp_ns =
    1'000'000'000;  // longer than that, the simulator itself was stopped

std::int64_t monotonic_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

void sleep_until(std::int64_t ns) {
  const timespec t{ns / 1'000'000'000, ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

// Baud rate that the driver's end is set to: a pseudo-terminal remembers it though it has no use for it.
int line_baud(int master) {
  constexpr struct {
    speed_t code;
    int baud;
  } kSpeeds[] = {{B300, 300},     {B600, 600},       {B1200, 1200},    {B2400, 2400},
                 {B4800, 4800},   {B9600, 9600},     {B19200, 19200},  {B38400, 38400},
                 {B57600, 57600}, {B115200, 115200}, {B230400, 230400}};
  termios mode{};
  if (tcgetattr(master, &mode) == 0)
    for (const auto& row : kSpeeds)
      if (row.code == cfgetospeed(&mode)) return row.baud;
  return 9600;
}

}  // namespace

CreatePty::CreatePty(const CreatePtyOptions& options) : options_(options), engine_(options.robot) {
  open_pair();
  try {
    make_link();
  } catch (...) {
    close_pair();
    throw;
  }
}

CreatePty::~CreatePty() {
  remove_link();
  close_pair();
}

void CreatePty::open_pair() {
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  char name[64];
  if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
      ptsname_r(master_, name, sizeof name) != 0)
    throw Failure(ExitCode::kDeviceFault,
                  std::string("simulated robot: no pseudo-terminal: ") + std::strerror(errno));
  path_ = name;
  // One own handle on the driver's end: without any, reading fails until somebody opens it.
  slave_ = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios mode{};
  tcgetattr(slave_, &mode);
  cfmakeraw(&mode);  // or the terminal would echo the robot's bytes back to it
  tcsetattr(slave_, TCSANOW, &mode);
}

void CreatePty::close_pair() {
  if (pulled()) return;
  close(slave_);
  close(master_);
  master_ = slave_ = -1;
}

void CreatePty::apply(WorldEventKind kind) {
  if (kind == WorldEventKind::kPull) {
    remove_link();
    close_pair();
  } else if (kind == WorldEventKind::kReplug && pulled()) {
    open_pair();
    make_link();
  } else {
    sim::apply(kind, engine_);
  }
}

void CreatePty::remove_link() {
  char target[256];
  const ssize_t n = readlink(options_.link_path.c_str(), target, sizeof target);
  if (n > 0 && std::string(target, static_cast<std::size_t>(n)) == path_) unlink(options_.link_path.c_str());
}

void CreatePty::make_link() {
  const std::string& link = options_.link_path;
  if (link.empty()) return;
  // A link that an earlier simulator left behind is replaced; anything else is somebody's.
  char target[256];
  const ssize_t n = readlink(link.c_str(), target, sizeof target);
  if (n > 0 && std::string(target, static_cast<std::size_t>(n)).starts_with("/dev/pts/"))
    unlink(link.c_str());
  if (symlink(path_.c_str(), link.c_str()) != 0)
    throw Failure(ExitCode::kBadInput,
                  "link " + link + ": " + std::strerror(errno) + "; name another with --link");
}

void CreatePty::exchange_bytes() {
  std::uint8_t bytes[4096];
  if (pulled()) {
    engine_.transmit(bytes);
    return;
  }
  engine_.set_host_baud(line_baud(master_));
  const ssize_t got = read(master_, bytes, sizeof bytes);
  if (got > 0) engine_.receive({bytes, static_cast<std::size_t>(got)});
  const std::size_t ready = engine_.transmit(bytes);
  // What nobody reads is lost, as on a cable.
  const ssize_t sent = ready > 0 ? write(master_, bytes, ready) : 0;
  static_cast<void>(sent);
}

SimStateEntry CreatePty::state(std::int64_t now_ns) const {
  const DiffDriveBody& body = engine_.body();
  const Pose2 pose = body.pose();
  const std::uint32_t conditions =
      (engine_.asleep() ? kSimAsleep : 0u) | (engine_.in_script_wait() ? kSimInScriptWait : 0u) |
      (engine_.world().on_charger ? kSimOnCharger : 0u) | (pulled() ? kSimPulled : 0u);
  return {now_ns,
          pose.x,
          pose.y,
          pose.yaw,
          body.left_mps(),
          body.right_mps(),
          body.v(),
          body.w(),
          engine_.wanted_mmps(0),
          engine_.wanted_mmps(1),
          engine_.mode(),
          conditions};
}

void CreatePty::run(const std::function<bool(double)>& ended) {
  std::unique_ptr<SimStateWriter> state_file;
  if (!options_.state_path.empty()) state_file = std::make_unique<SimStateWriter>(options_.state_path);
  std::vector<WorldEvent> events = options_.events;
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
  std::size_t next_event = 0;
  double t_s = 0;
  for (std::int64_t now_ns = monotonic_ns(); !ended(t_s);) {
    sleep_until(now_ns + kSlice_ns);
    exchange_bytes();
    const std::int64_t until_ns = monotonic_ns();
    if (until_ns - now_ns > kLongestCatchUp_ns) now_ns = until_ns - kSlice_ns;
    for (; now_ns + kSlice_ns <= until_ns; now_ns += kSlice_ns) {
      for (; next_event < events.size() && events[next_event].at_s <= t_s; ++next_event)
        apply(events[next_event].kind);
      engine_.step(CreateEngine::kSlice_s);
      t_s += CreateEngine::kSlice_s;
      if (state_file) state_file->publish(state(now_ns + kSlice_ns));
    }
  }
}

}  // namespace st::sim
