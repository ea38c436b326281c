// Frame count, and objects or the camera's state, on one line of stderr, while somebody looks.
#pragma once

#include <cstdint>

#include "hal/results/telemetry.hpp"

namespace st {

class ProgressLine final : public TelemetrySink {
 public:
  // `expected`: frames of the whole source; 0 when that is not known.
  explicit ProgressLine(std::uint64_t expected) : expected_(expected) {}
  ~ProgressLine() override;  // ends the line
  void take(const FrameReport& report) override;
  void flush() override;

 private:
  std::uint64_t expected_, frames_ = 0;
  int tracked_ = 0;
  bool scanning_ = false;
  TrackState camera_ = TrackState::kLost;
};

}  // namespace st
