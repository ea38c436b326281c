// A recording as a frame source: a reader thread decodes into an ordered ring, every frame comes, in order.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "hal/recording/recording_reader.hpp"
#include "hal/source/frame_source.hpp"

namespace st {

class ReplaySource final : public FrameSource {
 public:
  // `real_pace`: frames come when they came, by the device's clock, or later when the loop is slower; none is
  // skipped.
  ReplaySource(SourceInfo info, std::unique_ptr<RecordingReader> reader, bool real_pace);
  ~ReplaySource() override { stop(); }

  const SourceInfo& info() const override { return info_; }
  void start() override;
  Result next(FrameInput& out, int timeout_ms) override;
  std::string fault() const override { return fault_; }
  void stop() override;

 private:
  void read_all();
  void read_until_end();
  // Waits until the frame is due; false when that is later than the timeout.
  bool wait_until_due(const FrameInput& frame, int timeout_ms);

  SourceInfo info_;
  std::unique_ptr<RecordingReader> reader_;
  bool real_pace_;
  FrameRing ring_;
  std::thread thread_;
  std::string fault_;  // written before ring_.finish()

  FrameSlot* held_ = nullptr;     // handed out, released by the next call
  FrameSlot* pending_ = nullptr;  // taken from the ring, not due yet
  bool pace_started_ = false;
  double first_device_t_s_ = 0;
  std::int64_t first_due_ns_ = 0, due_ns_ = 0;
};

}  // namespace st
