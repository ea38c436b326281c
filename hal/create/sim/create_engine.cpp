#include "hal/create/sim/create_engine.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace st::sim {
namespace {

constexpr double kRobotRadius_m = 0.165;
constexpr double kPwmFull = 255;

int word(std::span<const std::uint8_t> data, std::size_t at) {
  return static_cast<std::int16_t>(data[at] << 8 | data[at + 1]);
}

constexpr std::string_view kBannerCreate1 = "\r\nbl-start\r\nflash CRC OK\r\nCreate 2006-10-27\r\n";
constexpr std::string_view kBannerCreate2 =
    "\r\nbl-start\r\nbootloader id: #x4718\r\nr3_robot/tags/release-3.5.4:6058 "
    "CLEAN\r\n2016-03-02-1158-L\r\n";

}  // namespace

CreateEngine::CreateEngine(const CreateOptions& options)
    : options_(options),
      geometry_(oi::default_geometry(options.model)),
      body_(geometry_.wheel_base_m, options.accel_mps2, options.errors, options.seed),
      odometer_(geometry_, options.seed, options.angle_keeps_fraction),
      to_robot_({}, options.seed),
      to_host_(options.noise, options.seed),
      baud_(oi::default_baud(options.model)),
      next_baud_(baud_),
      host_baud_(baud_) {}

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
  for (; !heard_by_robot_.empty(); heard_by_robot_.pop_front()) hear(heard_by_robot_.front());
  reflexes();
  const double wanted[2] = {wheel_mmps_[0] * 1e-3, wheel_mmps_[1] * 1e-3};
  body_.command(wanted[0], wanted[1]);
  body_.step(kSlice_s);
  const double wheel[2] = {body_.left_mps(), body_.right_mps()};
  odometer_.advance(wheel, wanted, kSlice_s);
  slot_s_ += kSlice_s;
  if (slot_s_ >= oi::kSlot_s - 1e-9) {
    slot_s_ -= oi::kSlot_s;
    if (streaming_ && mode_ != oi::kOff) send_stream_frame();
  }
  to_host_.advance(kSlice_s, baud_, host_baud_, heard_by_host_);
  if (world_.unplugged) heard_by_host_.clear();
  if (to_host_.waiting() == 0) baud_ = next_baud_;
}

void CreateEngine::hear(std::uint8_t byte) {
  if (mode_ == oi::kOff) {
    if (byte == oi::kStart) mode_ = oi::kPassive;
    if (byte == oi::kReset) reset();
    return;
  }
  command_.push_back(byte);
  const int length = oi::data_length(options_.model, command_[0], std::span(command_).subspan(1));
  if (length >= 0 && static_cast<int>(command_.size()) <= length) return;  // waits for its data, however long
  const std::vector<std::uint8_t> whole = std::move(command_);
  command_.clear();
  if (length >= 0) execute(whole[0], std::span(whole).subspan(1));
}

void CreateEngine::execute(std::uint8_t opcode, std::span<const std::uint8_t> data) {
  if (enter_mode(opcode)) return;
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

// Opcodes that do nothing but change the mode. Demos and cleaning drive the real robot about; here they only
// take control from the host, as they do there.
bool CreateEngine::enter_mode(std::uint8_t opcode) {
  switch (opcode) {
    case oi::kReset:
      reset();
      return true;
    case oi::kStart:
    case oi::kPower:
    case oi::kSpot:
    case oi::kCover:
    case oi::kDemo:
    case oi::kSeekDock:
      leave_control(oi::kPassive);
      return true;
    case oi::kStop:
      leave_control(oi::kOff);
      streaming_ = false;
      return true;
    case oi::kControl:
    case oi::kSafe:
    case oi::kFull:
      leave_control(opcode == oi::kFull ? oi::kFullMode : oi::kSafeMode);  // entering turns the motors off
      return true;
    default:
      return false;
  }
}

void CreateEngine::actuate(std::uint8_t opcode, std::span<const std::uint8_t> data) {
  switch (opcode) {
    case oi::kDrive: {
      const int v = word(data, 0), r = word(data, 2);
      const double half_mm = 500.0 * geometry_.wheel_base_m;
      const bool straight = r == oi::kStraight || r == 32767 || r == 0;
      if (straight)
        set_wheels(v, v);
      else if (std::abs(r) == 1)
        set_wheels(-r * v, r * v);
      else
        set_wheels(v * (1 - half_mm / r), v * (1 + half_mm / r));
      requested_velocity_ = v;
      requested_radius_ = r;
      return;
    }
    case oi::kDriveDirect:
      set_wheels(word(data, 2), word(data, 0));
      return;
    case oi::kDrivePwm: {
      const double per_step = oi::kMaxWheel_mmps / kPwmFull;
      set_wheels(word(data, 2) * per_step, word(data, 0) * per_step);
      return;
    }
    case oi::kPlay:
      if (time_s_ < song_ends_s_) return;  // a song that plays is not interrupted
      song_playing_ = data[0] % 16;
      song_ends_s_ = time_s_ + song_s_[song_playing_];
      return;
    default:
      return;  // lights, brushes, outputs: nothing that moves or answers
  }
}

void CreateEngine::set_wheels(double left_mmps, double right_mmps) {
  const double most = oi::kMaxWheel_mmps;
  wheel_mmps_[0] = std::clamp(left_mmps, -most, most);
  wheel_mmps_[1] = std::clamp(right_mmps, -most, most);
  requested_velocity_ = static_cast<int>(std::lround(0.5 * (wheel_mmps_[0] + wheel_mmps_[1])));
}

void CreateEngine::reflexes() {
  if (mode_ != oi::kSafeMode) return;
  const double v = 0.5e-3 * (wheel_mmps_[0] + wheel_mmps_[1]);
  const double w = 1e-3 * (wheel_mmps_[1] - wheel_mmps_[0]) / geometry_.wheel_base_m;
  const bool towards_edge = v > 0 || (v < 0 && std::fabs(v) < kRobotRadius_m * std::fabs(w));
  if ((world_.cliffs != 0 && towards_edge) || world_.wheel_drops != 0 || world_.on_charger)
    leave_control(oi::kPassive);
}

void CreateEngine::leave_control(oi::Mode mode) {
  mode_ = mode;
  set_wheels(0, 0);
  requested_radius_ = 0;
}

void CreateEngine::reset() {
  leave_control(oi::kOff);
  streaming_ = false;
  stream_.clear();
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
  frame.push_back(static_cast<std::uint8_t>(-sum));  // header counted: see StreamParser
  last_frame_bytes_ = frame.size();
  to_host_.send(frame);
}

void CreateEngine::append_packet(int packet, std::vector<std::uint8_t>& out) {
  const oi::PacketRange range = oi::packet_range(options_.model, packet);
  for (int id = range.first; id <= range.last; ++id) {
    const int value = value_of(id);
    if (oi::packet_size(options_.model, id) == 2) out.push_back(static_cast<std::uint8_t>(value >> 8));
    out.push_back(static_cast<std::uint8_t>(value));
  }
}

int CreateEngine::value_of(int packet) {
  switch (packet) {
    case oi::kBumpsWheelDrops:
      return (world_.bump_right ? 1 : 0) | (world_.bump_left ? 2 : 0) | (world_.wheel_drops & 0x1c);
    case oi::kCliffLeft:
    case oi::kCliffFrontLeft:
    case oi::kCliffFrontRight:
    case oi::kCliffRight:
      return world_.cliffs >> (packet - oi::kCliffLeft) & 1;
    case oi::kInfrared:
      return options_.model == RobotModel::kCreate1 ? 255 : 0;  // nothing received
    case oi::kDistance:
      return odometer_.read_distance_mm();
    case oi::kAngle:
      return odometer_.read_angle_deg();
    case oi::kChargingState:
      return world_.on_charger ? 2 : 0;
    case oi::kVoltage:
      return world_.battery_mv;
    case oi::kTemperature:
      return 25;
    case oi::kCharge:
      return world_.charge_mah;
    case oi::kCapacity:
      return 2696;
    case oi::kCliffLeftSignal:
    case oi::kCliffFrontLeftSignal:
    case oi::kCliffFrontRightSignal:
    case oi::kCliffRightSignal:
      return (world_.cliffs >> (packet - oi::kCliffLeftSignal) & 1) != 0 ? 0 : 1600;
    case oi::kChargers:
      return world_.on_charger ? 2 : 0;
    case oi::kOiMode:
      return mode_ + options_.mode_report_offset;
    case oi::kSongNumber:
      return song_playing_;
    case oi::kSongPlaying:
      return time_s_ < song_ends_s_ ? 1 : 0;
    case oi::kStreamCount:
      return static_cast<int>(stream_.size());
    default:
      return value_of_moving_parts(packet);
  }
}

int CreateEngine::value_of_moving_parts(int packet) const {
  const bool turns[2] = {body_.left_mps() != 0, body_.right_mps() != 0};
  switch (packet) {
    case oi::kCurrent:
      return -(180 + (turns[0] ? 90 : 0) + (turns[1] ? 90 : 0));
    case oi::kRequestedVelocity:
      return requested_velocity_;
    case oi::kRequestedRadius:
      return requested_radius_;
    case oi::kRequestedRight:
      return static_cast<int>(std::lround(wheel_mmps_[1]));
    case oi::kRequestedLeft:
      return static_cast<int>(std::lround(wheel_mmps_[0]));
    case oi::kEncoderLeft:
      return odometer_.count(0);
    case oi::kEncoderRight:
      return odometer_.count(1);
    case oi::kCurrentLeft:
      return turns[0] ? 90 : 0;
    case oi::kCurrentRight:
      return turns[1] ? 90 : 0;
    case oi::kStasis:
      return body_.v() > 0 ? 1 : 0;
    default:
      return 0;
  }
}

}  // namespace st::sim
