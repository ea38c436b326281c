#include "hal/create/sim/create_engine.hpp"

#include <algorithm>

namespace st::sim {
namespace {

constexpr std::size_t kMostBytesASlice = 200;  // ends a script that plays itself and never waits
constexpr std::size_t kReceiveBuffer = 256;

constexpr std::string_view kBannerCreate1 = "\r\nbl-start\r\nflash CRC OK\r\nCreate 2006-10-27\r\n";
constexpr std::string_view kBannerCreate2 =
    "\r\nbl-start\r\nbootloader id: #x4718\r\nr3_robot/tags/release-3.5.4:6058 "
    "CLEAN\r\n2016-03-02-1158-L\r\n";

}  // namespace

CreateEngine::CreateEngine(const CreateOptions& options)
    : options_(options),
      geometry_(oi::default_geometry(options.model)),
      body_(geometry_.wheel_base_m * options.base_scale, options.accel_mps2, options.errors, options.seed),
      odometer_(geometry_, options.seed, options.angle_keeps_fraction),
      to_robot_(options.noise_to_robot, options.seed + 1),
      to_host_(options.noise, options.seed),
      baud_(options.start_baud != 0 ? options.start_baud : oi::default_baud(options.model)),
      next_baud_(baud_),
      host_baud_(baud_),
      commands_(options.model),
      random_(options.seed, 0x4a1f) {}

void CreateEngine::step(double dt_s) {
  carried_s_ += dt_s;
  while (carried_s_ >= kSlice_s - 1e-9) {
    carried_s_ -= kSlice_s;
    slice();
  }
}

std::size_t CreateEngine::transmit(std::span<std::uint8_t> out) {
  const std::size_t n = std::min(out.size(), heard_by_host_.size());
  std::copy_n(heard_by_host_.begin(), n, out.begin());
  heard_by_host_.erase(heard_by_host_.begin(), heard_by_host_.begin() + static_cast<std::ptrdiff_t>(n));
  return n;
}

void CreateEngine::say(std::string_view text) {
  to_host_.send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void CreateEngine::slice() {
  time_s_ += kSlice_s;
  to_robot_.advance(kSlice_s, host_baud_, baud_, heard_by_robot_);
  if (world_.unplugged) heard_by_robot_.clear();
  listen();
  reflexes();
  seek_dock();
  move();
  mind_time();
  to_host_.advance(kSlice_s, baud_, host_baud_, heard_by_host_);
  if (world_.unplugged || world_.mute) heard_by_host_.clear();
  if (to_host_.waiting() == 0) baud_ = next_baud_;
}

// The script that plays comes first. While it waits nobody is heard; what the host says meanwhile stands in
// the receive buffer, and what does not fit there is lost.
void CreateEngine::listen() {
  for (std::size_t bytes = 0; bytes < kMostBytesASlice; ++bytes) {
    if (asleep_) heard_by_robot_.clear();
    if (script_.waiting()) {
      if (heard_by_robot_.size() > kReceiveBuffer) heard_by_robot_.resize(kReceiveBuffer);
      script_.look(time_s_, odometer_, event_holds(script_.awaited_event()));
      if (script_.waiting()) return;
    }
    std::uint8_t byte;
    if (script_.has_byte()) {
      byte = script_.next_byte();
    } else if (!heard_by_robot_.empty()) {
      byte = heard_by_robot_.front();
      heard_by_robot_.pop_front();
      spoken_to_s_ = time_s_;
    } else {
      return;
    }
    if (mode_ == oi::kOff && byte == oi::kStart) mode_ = oi::kPassive;
    if (mode_ == oi::kOff && byte == oi::kReset) reset();
    if (mode_ == oi::kOff || !commands_.push(byte)) continue;
    const std::vector<std::uint8_t> whole(commands_.command().begin(), commands_.command().end());
    execute(whole);
  }
}

void CreateEngine::move() {
  const double wanted[2] = {world_.blocked ? 0 : wheel_mmps_[0] * 1e-3,
                            world_.blocked ? 0 : wheel_mmps_[1] * 1e-3};
  body_.command(wanted[0], wanted[1]);
  body_.step(kSlice_s);
  const double wheel[2] = {body_.left_mps(), body_.right_mps()};
  odometer_.advance(wheel, wanted, kSlice_s);
}

// What comes with time alone: a frame every slot, sleep, text of the firmware's own.
void CreateEngine::mind_time() {
  slot_s_ += kSlice_s;
  if (slot_s_ >= oi::kSlot_s - 1e-9) {
    slot_s_ -= oi::kSlot_s;
    if (streaming_ && mode_ != oi::kOff && !script_.waiting()) send_stream_frame();
  }
  const bool idle = options_.model == RobotModel::kCreate2 && mode_ == oi::kPassive && !world_.on_charger;
  if (idle && options_.sleep_after_s > 0 && time_s_ - spoken_to_s_ > options_.sleep_after_s) fall_asleep();
  if (options_.text_every_s > 0 && !asleep_ && time_s_ - text_s_ > options_.text_every_s) {
    text_s_ = time_s_;
    say(kBatteryText);
  }
}

void CreateEngine::fall_asleep() {
  leave_control(oi::kOff);
  streaming_ = false;
  asleep_ = true;
  to_host_.discard();
}

void CreateEngine::execute(std::span<const std::uint8_t> command) {
  const std::uint8_t opcode = command[0];
  const std::span<const std::uint8_t> data = command.subspan(1);
  if (enter_mode(opcode) || execute_script(opcode, data)) return;
  switch (opcode) {
    case oi::kBaud:
      if (oi::baud_of_code(data[0]) != 0) next_baud_ = oi::baud_of_code(data[0]);
      return;
    case oi::kSong:
      song_s_[data[0] % 16] = 0;
      for (std::size_t i = 3; i < data.size(); i += 2) song_s_[data[0] % 16] += data[i] / 64.0;
      return;
    case oi::kSensors:
    case oi::kQueryList: {
      std::vector<std::uint8_t> reply;
      for (const std::uint8_t packet : data.subspan(opcode == oi::kQueryList ? 1 : 0))
        append_packet(packet, reply);
      to_host_.send(reply);
      return;
    }
    case oi::kStream:
      stream_.assign(data.begin() + 1, data.end());
      streaming_ = !stream_.empty();
      return;
    case oi::kPauseResume:
      streaming_ = data[0] != 0 && !stream_.empty();
      return;
    default:
      break;
  }
  if (mode_ == oi::kSafeMode || mode_ == oi::kFullMode) actuate(opcode, data);
}

bool CreateEngine::execute_script(std::uint8_t opcode, std::span<const std::uint8_t> data) {
  switch (opcode) {
    case oi::kScript:
      script_.store(data.subspan(1));
      return true;
    case oi::kPlayScript:
      script_.play();
      return true;
    case oi::kShowScript: {
      std::vector<std::uint8_t> reply = {static_cast<std::uint8_t>(script_.stored().size())};
      reply.insert(reply.end(), script_.stored().begin(), script_.stored().end());
      to_host_.send(reply);
      streaming_ = false;  // as the specification says
      return true;
    }
    case oi::kWaitTime:
      script_.wait_time(time_s_ + 0.1 * data[0]);
      return true;
    case oi::kWaitDistance:
      script_.wait_distance(word_of(data, 0), odometer_);
      return true;
    case oi::kWaitAngle:
      script_.wait_angle(word_of(data, 0), odometer_);
      return true;
    case oi::kWaitEvent:
      script_.wait_event(static_cast<std::int8_t>(data[0]));
      return true;
    default:
      return false;
  }
}

void CreateEngine::reset() {
  leave_control(oi::kOff);
  streaming_ = false;
  stream_.clear();
  script_.stop();
  commands_.forget();
  to_host_.discard();
  next_baud_ = oi::default_baud(options_.model);
  say(options_.model == RobotModel::kCreate1 ? kBannerCreate1 : kBannerCreate2);
}

void CreateEngine::send_stream_frame() {
  // A frame that did not leave within its slot is torn by the next one.
  if (last_frame_bytes_ > static_cast<std::size_t>(oi::kSlot_s * baud_ / 10)) to_host_.discard();
  std::vector<std::uint8_t> frame = {19, 0};
  for (const std::uint8_t packet : stream_) {
    if (oi::packet_size(options_.model, packet) == 0) continue;
    frame.push_back(packet);
    append_packet(packet, frame);
  }
  frame[1] = static_cast<std::uint8_t>(frame.size() - 2);
  unsigned sum = 0;
  for (const std::uint8_t byte : frame) sum += byte;
  if (options_.checksum_leaves_header) sum -= frame[0];
  frame.push_back(static_cast<std::uint8_t>(-sum));
  if (options_.half_frames > 0 && random_.uniform() < options_.half_frames)
    frame.resize(static_cast<std::size_t>(random_.below(static_cast<int>(frame.size()))));
  last_frame_bytes_ = frame.size();
  to_host_.send(frame);
}

}  // namespace st::sim
