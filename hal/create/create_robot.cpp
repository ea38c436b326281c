#include "hal/create/create_robot.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "hal/clock.hpp"
#include "hal/error.hpp"

namespace st {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSilent_ns = kSilent_ms * kMs;
constexpr std::int64_t kModeGap_ns = 50 * kMs;  // a mode command sooner after another may be ignored
constexpr std::int64_t kAskAgain_ns = 400 * kMs;
constexpr std::int64_t kLongSilence_ns = 1000 * kMs;  // reset, asleep or unplugged: it is met anew
constexpr std::int64_t kDistancePeriod_ns =
    300 * kMs;  // Create 1: seldom, since each reading rounds to a degree
constexpr int kReaderWait_ms = 20;
constexpr std::int64_t kLongestTurn_ns = 2 * kReaderWait_ms * kMs;  // of the reader, while it runs at all
constexpr int kControlTries = 5, kControlWait_ms = 400;
constexpr int kGuardEnd_ms = 1000;
constexpr int kLastTries_ms = 3000;

// What every model is asked for, slot after slot; 59 bytes a frame at most, which fits 57600 baud.
constexpr std::uint8_t kCommonPackets[] = {7, 9, 10, 11, 12, 13, 14, 21, 22, 23, 24, 25, 26, 34, 35, 41, 42};
constexpr std::uint8_t kCreate2Packets[] = {43, 44, 45, 54, 55, 58};
constexpr std::uint8_t kDistancePackets[] = {19, 20};

oi::Command stream_list(RobotModel model, bool with_distance) {
  std::vector<std::uint8_t> packets(std::begin(kCommonPackets), std::end(kCommonPackets));
  if (model == RobotModel::kCreate2)
    packets.insert(packets.end(), std::begin(kCreate2Packets), std::end(kCreate2Packets));
  if (with_distance) packets.insert(packets.end(), std::begin(kDistancePackets), std::end(kDistancePackets));
  return oi::stream(packets);
}

}  // namespace

CreateRobot::CreateRobot(std::unique_ptr<RobotPort> port, const RobotIdentity& identity,
                         const RobotGeometry& wheels, std::unique_ptr<RobotLogWriter> log,
                         std::unique_ptr<SimChild> sim)
    : identity_(identity),
      geometry_(wheels),
      left_scale_(wheel_scale(oi::default_geometry(identity.model), wheels) * wheel_shares(wheels).left),
      right_scale_(wheel_scale(oi::default_geometry(identity.model), wheels) * wheel_shares(wheels).right),
      port_(port->address()),
      log_(std::move(log)),
      sim_(std::move(sim)),
      guard_(start_guard(port->fd(), port_, orders_for(identity.model), sim_ ? sim_->lifeline() : -1)),
      heard_ns_(system_clock().monotonic_ns()),
      stream_(identity.model, geometry_) {
  log_->set_robot(identity.model, geometry_);
  // Signals are for the program's own threads.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  reader_ = std::thread([this] { read_robot(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void CreateRobot::take_control() {
  send(stream_list(identity_.model, false));
  const timespec moment{0, 5 * kMs};
  for (int attempt = 0; attempt < kControlTries; ++attempt) {
    send(oi::simple(oi::kSafe));
    const std::uint64_t before = good_frames_.load();
    for (int waited_ms = 0; waited_ms < kControlWait_ms && !disconnected_.load(); waited_ms += 5) {
      nanosleep(&moment, nullptr);
      const bool told =
          identity_.mode_trusted ? mode_.load() == oi::kSafeMode : good_frames_.load() > before + 10;
      if (!told) continue;
      noted_.store(0);
      standstill_.store(false);
      in_control_.store(true);
      return;
    }
  }
  const char* why = good_frames_.load() == 0
                        ? "its sensor stream does not come; switch it off and on"
                        : "it refuses Safe mode; take it off the charger and put all wheels on the floor, "
                          "away from edges";
  throw Failure(ExitCode::kDeviceFault, "robot port " + port_.text + ": the robot answers, but " + why);
}

bool CreateRobot::send(const oi::Command& command) {
  return ::send(guard_.link, command.bytes, command.size, MSG_DONTWAIT | MSG_NOSIGNAL) ==
         static_cast<ssize_t>(command.size);
}

bool CreateRobot::drive(double left_mps, double right_mps) {
  const bool sane = std::isfinite(left_mps) && std::isfinite(right_mps);
  const bool still = !sane || standstill_.load();
  // As the robot counts them. Both wheels give way alike, so that the curve stays the same.
  const double left = still ? 0 : 1000 * left_mps / left_scale_,
               right = still ? 0 : 1000 * right_mps / right_scale_;
  const double fastest = std::max(std::fabs(left), std::fabs(right));
  const double scale = fastest > oi::kMaxWheel_mmps ? oi::kMaxWheel_mmps / fastest : 1.0;
  const auto mmps = [&](double speed) { return static_cast<int>(std::lround(speed * scale)); };
  return send(oi::drive_direct(mmps(left), mmps(right))) && sane && !disconnected_.load();
}

// What is asked for after this is meant for the robot as it is now: a standstill is over once the robot is
// heard again and obeys.
bool CreateRobot::stop() {
  if (in_control_.load() && !lost_contact()) standstill_.store(false);
  return send(oi::halt());
}

bool CreateRobot::lost_contact() const {
  return disconnected_.load() || listened_in_vain_ns_.load() > kSilent_ns;
}

void CreateRobot::poll(FixedVector<OdometrySample, 64>& odometry, RobotStatus& status) {
  // Up to a place in the log, so that a replay gives each frame the same travel.
  status.log_bytes = log_bytes_.load();
  while (!odometry.full() && (has_early_ || travel_.pop(early_))) {
    has_early_ = early_.log_bytes > status.log_bytes;
    if (has_early_) break;
    odometry.push_back(early_.sample);
  }
  const std::int64_t now_ns = system_clock().monotonic_ns();
  status.fault = worst_fault();
  status.last_heard_s = static_cast<double>(now_ns - heard_ns_.load()) * 1e-9;
  status.good_frames = good_frames_.load();
  status.bad_bytes = bad_bytes_.load();
  status.oi_mode = mode_.load();
  status.battery_mv = battery_mv_.load();
  status.reconnects = reconnects_.load();
}

// What was noted since the last call, worst first. A bump of a few slots must not fall between two calls.
RobotFault CreateRobot::worst_fault() {
  const std::uint32_t noted = noted_.exchange(0);
  if (disconnected_.load()) return RobotFault::kDisconnected;
  if (listened_in_vain_ns_.load() > kSilent_ns) return RobotFault::kSilent;
  for (const RobotFault fault :
       {RobotFault::kDisconnected, RobotFault::kSilent, RobotFault::kWheelDrop, RobotFault::kCliff,
        RobotFault::kBump, RobotFault::kLeftSafeMode, RobotFault::kLowBattery})
    if ((noted >> static_cast<unsigned>(fault) & 1) != 0) return fault;
  return RobotFault::kNone;
}

void CreateRobot::read_robot() {
  std::uint8_t message[kGuardMessageBytes];
  for (std::int64_t last_ns = system_clock().monotonic_ns();;) {
    pollfd ready{guard_.link, POLLIN, 0};
    if (::poll(&ready, 1, kReaderWait_ms) > 0) {
      const ssize_t n = recv(guard_.link, message, sizeof message, MSG_DONTWAIT);
      if (n == 0) break;
      if (n > 0) on_message({message, static_cast<std::size_t>(n)});
    }
    const std::int64_t now_ns = system_clock().monotonic_ns();
    // A computer that itself stood still for a while has not listened.
    listened_in_vain_ns_.fetch_add(std::min(now_ns - last_ns, kLongestTurn_ns));
    last_ns = now_ns;
    if (in_control_.load() && lost_contact()) {
      note(RobotFault::kSilent);
      standstill_.store(true);
      if (listened_in_vain_ns_.load() > kLongSilence_ns) begin_regaining(now_ns);
    }
    if (regain_ns_ != 0) regain_control(now_ns);
    if (identity_.model == RobotModel::kCreate1 && in_control_.load()) ask_for_distance(now_ns);
  }
  disconnected_.store(true);
  if (!closing_.load()) stop_without_guard();
}

void CreateRobot::begin_regaining(std::int64_t now_ns) {
  in_control_.store(false);
  mode_.store(oi::kOff);
  regain_ns_ = now_ns;
  regain_safe_ = false;
}

// Passive, the stream, Safe mode, one at a time.
void CreateRobot::regain_control(std::int64_t now_ns) {
  if (mode_.load() == oi::kSafeMode && !lost_contact()) {
    in_control_.store(true);
    regain_ns_ = 0;
    return;
  }
  if (now_ns < regain_ns_) return;
  if (regain_safe_) {
    send(oi::simple(oi::kSafe));
  } else {
    send(oi::simple(oi::kStart));
    send(stream_list(identity_.model, false));
  }
  regain_ns_ = now_ns + (regain_safe_ ? kAskAgain_ns : kModeGap_ns);
  regain_safe_ = !regain_safe_;
}

void CreateRobot::on_message(std::span<const std::uint8_t> message) {
  const double t_s = host_seconds();
  const std::span<const std::uint8_t> bytes = message.subspan(1);
  if (message[0] == kGuardPortGone) {
    in_control_.store(false);
    standstill_.store(true);
    note(RobotFault::kDisconnected);
    disconnected_.store(true);
  }
  if (message[0] == kGuardPortBack) {
    begin_regaining(system_clock().monotonic_ns());
    reconnects_.fetch_add(1);
    disconnected_.store(false);
  }
  log_->add(t_s, message[0] == kGuardReceived, bytes);
  if (message[0] == kGuardSent) stream_.sent(bytes);
  if (message[0] != kGuardReceived) return;
  stream_.receive(
      t_s, bytes, [this](const SensorState& state) { on_frame(state); },
      [this](const OdometrySample& sample) {
        travel_.push({sample, log_->bytes()});
      });
  log_bytes_.store(log_->bytes());
  bad_bytes_.store(stream_.parser().bad_bytes());
}

void CreateRobot::on_frame(const SensorState& state) {
  const std::int64_t now_ns = system_clock().monotonic_ns();
  if (state.has(oi::kDistance)) distance_came_ = true;
  battery_mv_.store(state.value(oi::kVoltage));
  const int mode = identity_.mode_trusted ? state.value(oi::kOiMode) - identity_.mode_offset : oi::kSafeMode;
  mode_.store(mode);
  heard_ns_.store(now_ns);
  listened_in_vain_ns_.store(0);
  good_frames_.store(stream_.parser().good_frames());
  if (state.bump_left() || state.bump_right()) note(RobotFault::kBump);
  if (state.wheel_drop()) note(RobotFault::kWheelDrop);
  if (state.cliff()) note(RobotFault::kCliff);
  if (in_control_.load() && mode < oi::kSafeMode) note(RobotFault::kLeftSafeMode);
  const bool empty = state.value(oi::kCharge) * 100 < state.value(oi::kCapacity) * kEmpty_percent ||
                     state.value(oi::kVoltage) < kEmpty_mv;
  if (!empty || weak_since_ns_ == 0) weak_since_ns_ = now_ns;  // a dip under load is none
  if (now_ns - weak_since_ns_ > kEmpty_ms * kMs) note(RobotFault::kLowBattery);
}

// Create 1: distance and angle join the stream for a frame now and then, so that they come under its
// checksum.
void CreateRobot::ask_for_distance(std::int64_t now_ns) {
  const bool due = now_ns - distance_asked_ns_ > kDistancePeriod_ns;
  const bool got = distance_in_list_ && distance_came_;
  if (!due && !got) return;
  distance_in_list_ = !got;
  distance_came_ = false;
  if (distance_in_list_) distance_asked_ns_ = now_ns;
  send(stream_list(identity_.model, distance_in_list_));
}

// The guard was killed. Its port is free again: the robot must not go on with its last command.
void CreateRobot::stop_without_guard() {
  try {
    RobotPort port(port_.text, identity_.baud);
    port.write(oi::halt().span());
    log_->add(host_seconds(), false, oi::halt().span());
  } catch (const Failure&) {
    // The port is gone as well, and nothing reaches the robot.
  }
}

// A robot that is silent may have lost its plug and be driving on: for a few seconds it is told to stop as
// soon as it hears again.
void CreateRobot::stop_for_good() {
  const timespec moment{0, 20 * kMs};
  const std::int64_t end_ns = system_clock().monotonic_ns() + kLastTries_ms * kMs;
  for (;;) {
    stop();
    const std::int64_t now_ns = system_clock().monotonic_ns();
    if (disconnected_.load() || !lost_contact() || now_ns > end_ns) return;
    nanosleep(&moment, nullptr);
  }
}

void CreateRobot::close() {
  if (closing_.exchange(true)) return;
  stop_for_good();
  shutdown(guard_.link,
           SHUT_WR);  // the guard stops the robot once more, says farewell and ends; its echo is still logged
  // Without a port it stays on, to stop the robot should the port come back.
  if (disconnected_.load() || !wait_for_child(guard_.pid, kGuardEnd_ms)) shutdown(guard_.link, SHUT_RDWR);
  reader_.join();
  ::close(guard_.link);
  sim_.reset();
}

}  // namespace st
