// A folder in the TUM RGB-D layout: depth.txt, perhaps rgb.txt, PNG images.
#pragma once

#include <optional>

#include "hal/recording/recording_reader.hpp"

namespace st {

class TumReader final : public RecordingReader {
 public:
  TumReader(const std::string& folder, const Calibration& calibration, double period_s,
            const OdometryDecoder& decoder);

 private:
  struct Image {
    double t_s = 0;
    std::string path;
  };

  bool read_frame(FrameSlot& slot) override;
  bool next_entry(LineReader& lines, Stream stream, std::optional<double>& last_t_s, Image& image);
  bool decode_color(const Image& image);
  void attach_color(FrameInput& frame);

  LineReader depth_list_, color_list_;
  std::optional<double> depth_t_s_, color_t_s_;  // of the last entry taken from each list
  Image color_ahead_;
  bool has_color_ahead_ = false, has_color_ = false;
  double color_shown_t_s_ = 0;
};

}  // namespace st
