#include "hal/recording/recording_reader.hpp"

#include <cmath>

#include "hal/create/oi.hpp"

namespace st {
namespace {

// A frame and its header, and room to see that a file is larger than any that is accepted.
constexpr std::size_t kMaxFileBytes = static_cast<std::size_t>(kMaxWidth) * kMaxHeight * 3 + (1 << 16);

}  // namespace

RecordingReader::RecordingReader(std::string folder, const Calibration& calibration, double period_s,
                                 const OdometryDecoder& decoder)
    : folder_(std::move(folder)), calibration_(calibration), period_s_(period_s), file_(kMaxFileBytes) {
  // One more than the frames in use, so that the buffer that is written is never one that is read.
  const std::size_t bytes = static_cast<std::size_t>(calibration.color.width) *
                            static_cast<std::size_t>(calibration.color.height) * 3;
  colors_.assign(FrameRing::kSlots + 1, std::vector<std::uint8_t>(bytes));
  open_robot_log(decoder);
}

void RecordingReader::open_robot_log(const OdometryDecoder& decoder) {
  if (!decoder || !robot_log_.open(path_of("robot.log")) || !robot_log_.model()) return;
  robot_bytes_ = decoder(*robot_log_.model(), robot_log_.geometry(),
                         [this](const OdometrySample& s) { odometry_.push_back(s); });
}

double RecordingReader::wheel_base_m() const {
  if (!has_robot_log()) return 0;
  return robot_log_.geometry().value_or(oi::default_geometry(*robot_log_.model())).wheel_base_m;
}

bool RecordingReader::read(FrameSlot& slot) {
  slot.frame = FrameInput{};
  if (!read_frame(slot)) return false;
  FrameInput& frame = slot.frame;
  frame.index = usable_;
  frame.depth = {slot.depth.data(), calibration_.depth.width, calibration_.depth.height};
  if (frame.color_is_new) {
    color_seen_ = true;
    color_size_damage_.clear();
  }
  if (robot_log_.bad_lines() > bad_robot_lines_) {
    note_damage(frame.t_s, DamageReason::kForeign, Stream::kRobotLog, "robot.log", "unreadable lines");
    bad_robot_lines_ = robot_log_.bad_lines();
  }
  note_gap(frame);
  for (; !events_.empty() && frame.events.push_back(events_.front()); events_.pop_front()) {
  }
  hand_over_odometry(frame);
  last_device_t_s_ = frame.device_t_s;
  ++usable_;
  return true;
}

void RecordingReader::note_gap(const FrameInput& frame) {
  const double elapsed_s = frame.device_t_s - last_device_t_s_;
  if (usable_ == 0 || elapsed_s <= 1.5 * period_s_) return;
  Event gap;
  gap.t_s = frame.t_s;
  gap.kind = EventKind::kGap;
  gap.a = elapsed_s;
  gap.b = std::nearbyint(elapsed_s / period_s_) - 1;
  events_.push_back(gap);
}

void RecordingReader::flush_events(FrameInput& last) {
  for (; !events_.empty(); events_.pop_front()) {
    if (last.events.full()) last.events.pop_back();  // `a` counts on, so the newest tells of all
    last.events.push_back(events_.front());
  }
}

void RecordingReader::hand_over_odometry(FrameInput& frame) {
  for (; !odometry_.empty(); odometry_.pop_front()) {
    const OdometrySample& sample = odometry_.front();
    if (frame.odometry.push_back(sample)) continue;
    // Travel adds up: over a long gap the last sample takes the rest.
    OdometrySample& last = frame.odometry[frame.odometry.size() - 1];
    last.t_s = sample.t_s;
    last.left_m += sample.left_m;
    last.right_m += sample.right_m;
  }
}

void RecordingReader::note_damage(double t_s, DamageReason reason, Stream stream, const std::string& file,
                                  const std::string& what) {
  ++damaged_;
  Event event;
  event.t_s = t_s;
  event.kind = EventKind::kDamaged;
  event.a = static_cast<double>(damaged_);
  event.b = static_cast<double>(reason);
  event.c = static_cast<double>(stream);
  events_.push_back(event);
  const std::string text = file + ": " + what;
  if (stream == Stream::kDepth && first_damage_.empty()) first_damage_ = text;
  const bool color_size = stream == Stream::kColor && reason == DamageReason::kWrongSize;
  if (color_size && !color_seen_ && color_size_damage_.empty()) color_size_damage_ = text;
}

bool RecordingReader::load(double t_s, Stream stream, std::string_view name,
                           std::span<const std::uint8_t>& bytes) {
  const std::int64_t size = read_whole_file(path_of(name), file_);
  if (size == -1) {
    note_damage(t_s, DamageReason::kMissing, stream, std::string(name), "missing or not readable");
    return false;
  }
  if (size == -2) {
    note_damage(t_s, DamageReason::kWrongSize, stream, std::string(name), "larger than a 640x480 image");
    return false;
  }
  bytes = {file_.data(), static_cast<std::size_t>(size)};
  return true;
}

std::span<std::uint8_t> RecordingReader::next_color_buffer() {
  return colors_[(static_cast<std::size_t>(color_index_) + 1) % colors_.size()];
}

ImageView<const std::uint8_t> RecordingReader::color_view() const {
  return {colors_[static_cast<std::size_t>(color_index_)].data(), 3 * calibration_.color.width,
          calibration_.color.height};
}

}  // namespace st
