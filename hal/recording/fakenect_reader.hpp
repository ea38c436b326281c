// A folder as fakenect-record writes it: INDEX.txt, one file per frame.
#pragma once

#include <deque>

#include "hal/recording/fakenect_index.hpp"
#include "hal/recording/frames_csv.hpp"
#include "hal/recording/recording_reader.hpp"
#include "hal/source/stamp_clock.hpp"

namespace st {

class FakenectReader final : public RecordingReader {
 public:
  FakenectReader(const std::string& folder, const Calibration& calibration, double period_s,
                 const OdometryDecoder& decoder);

 private:
  struct ColorCandidate {
    std::string name;
    double host_s = 0;
    std::uint32_t ticks = 0;
  };

  bool read_frame(FrameSlot& slot) override;
  bool read_depth(const IndexEntry& entry, FrameSlot& slot);
  bool decode_depth(const IndexEntry& entry, std::span<const std::uint8_t> file,
                    std::vector<std::uint16_t>& depth);
  void note_color(const IndexEntry& entry);
  void attach_color(const FramesRow* row, FrameInput& frame);
  bool show_color(const ColorCandidate& candidate, FrameInput& frame);
  void attach_gravity(FrameInput& frame);

  LineReader index_;
  FramesCsv frames_csv_;
  StampClock depth_clock_, color_clock_;
  std::deque<ColorCandidate> candidates_;  // newest last
  std::string shown_color_;                // the file that color_view() holds
  std::int64_t good_color_bytes_ = 0;      // that it has at least
  std::string tilt_name_;
  std::optional<Vec3> up_mps2_;
  bool tilt_refused_ = false;
};

}  // namespace st
