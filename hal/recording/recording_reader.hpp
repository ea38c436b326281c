// Reads a recording frame by frame, in order, skipping what is damaged. What the two layouts share: the
// events, the gaps, the colour buffers, the robot's log. Used by one thread, on which heap and file access
// are fine.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "algo/core/calibration.hpp"
#include "hal/recording/robot_log.hpp"
#include "hal/source/frame_ring.hpp"

namespace st {

class RecordingReader {
 public:
  virtual ~RecordingReader() = default;

  // Fills the slot with the next usable frame; the views point into the slot and into the reader's colour
  // buffers, which hold while FrameRing::kSlots frames are in use. False at the end.
  bool read(FrameSlot& slot);

  // At the end: puts what happened after the last frame onto that frame. What does not fit is summed up in
  // the last event.
  void flush_events(FrameInput& last);

  // Of the robot whose log stands beside the frames; 0: there is none.
  double wheel_base_m() const;

  std::uint64_t usable() const { return usable_; }
  std::uint64_t damaged() const { return damaged_; }
  // "file: what" of the first damaged depth frame; empty when there is none.
  const std::string& first_damage() const { return first_damage_; }
  // The same of the first colour image of a wrong size, as long as none of the right size was met.
  const std::string& color_size_damage() const { return color_size_damage_; }

 protected:
  // What a damaged event's c says.
  enum class Stream { kDepth = 0, kColor = 1, kTilt = 2, kRobotLog = 3 };

  RecordingReader(std::string folder, const Calibration& calibration, double period_s,
                  const OdometryDecoder& decoder);

  // Fills slot.depth and the frame's stamps, colour and gravity.
  virtual bool read_frame(FrameSlot& slot) = 0;

  void note_damage(double t_s, DamageReason reason, Stream stream, const std::string& file,
                   const std::string& what);
  std::string path_of(std::string_view name) const { return folder_ + "/" + std::string(name); }
  const Calibration& calibration() const { return calibration_; }

  // A whole file in memory; false, and noted, when it is missing or absurdly large.
  bool load(double t_s, Stream stream, std::string_view name, std::span<const std::uint8_t>& bytes);

  // The buffer that the next colour image goes to; it counts once use_color() says that it holds a good one.
  std::span<std::uint8_t> next_color_buffer();
  void use_color() { color_index_ = (color_index_ + 1) % static_cast<int>(colors_.size()); }
  // The image that use_color() took last.
  ImageView<const std::uint8_t> color_view() const;

  bool has_robot_log() const { return robot_log_.is_open() && robot_bytes_; }
  void pump_robot_until_time(double t_s) { robot_log_.pump_until_time(t_s, robot_bytes_); }
  void pump_robot_until_offset(std::uint64_t offset) { robot_log_.pump_until_offset(offset, robot_bytes_); }

 private:
  void open_robot_log(const OdometryDecoder& decoder);
  void note_gap(const FrameInput& frame);
  void hand_over_odometry(FrameInput& frame);

  std::string folder_;
  Calibration calibration_;
  double period_s_;

  std::uint64_t usable_ = 0, damaged_ = 0, bad_robot_lines_ = 0;
  double last_device_t_s_ = 0;
  std::string first_damage_, color_size_damage_;
  bool color_seen_ = false;
  std::deque<Event> events_;

  std::vector<std::uint8_t> file_;
  std::vector<std::vector<std::uint8_t>> colors_;
  int color_index_ = 0;

  RobotLogReader robot_log_;
  RobotBytes robot_bytes_;
  std::deque<OdometrySample> odometry_;
};

}  // namespace st
