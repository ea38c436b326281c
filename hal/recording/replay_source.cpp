#include "hal/recording/replay_source.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "hal/clock.hpp"

namespace st {

ReplaySource::ReplaySource(SourceInfo info, std::unique_ptr<RecordingReader> reader, bool real_pace)
    : info_(std::move(info)), reader_(std::move(reader)), real_pace_(real_pace) {}

void ReplaySource::start() {
  thread_ = std::thread([this] { read_all(); });
}

void ReplaySource::stop() {
  ring_.cancel();
  if (thread_.joinable()) thread_.join();
}

void ReplaySource::read_all() {
  try {
    read_until_end();
  } catch (const std::exception& error) {
    fault_ = info_.name + ": " + error.what();
  }
  ring_.finish();
}

// Runs one frame ahead of what it publishes, so that damage behind the last frame is told with that frame.
void ReplaySource::read_until_end() {
  FrameSlot* last = nullptr;
  for (FrameSlot* slot = ring_.acquire(); slot != nullptr && reader_->read(*slot); slot = ring_.acquire()) {
    if (last != nullptr) ring_.publish();
    last = slot;
  }
  if (last == nullptr || ring_.cancelled()) return;
  reader_->flush_events(last->frame);
  ring_.publish();
}

FrameSource::Result ReplaySource::next(FrameInput& out, int timeout_ms) {
  if (held_ != nullptr) ring_.release();
  held_ = nullptr;
  if (pending_ == nullptr) pending_ = ring_.front(timeout_ms);
  if (ring_.cancelled()) return Result::kEnd;
  if (pending_ == nullptr) {
    if (!ring_.ended()) return Result::kTimeout;
    return fault_.empty() ? Result::kEnd : Result::kFault;
  }
  if (real_pace_ && !wait_until_due(pending_->frame, timeout_ms)) return Result::kTimeout;
  held_ = pending_;
  pending_ = nullptr;
  out = held_->frame;
  // Fast, a frame is as old as its hand-over; at real pace its age counts from when it would have come.
  out.complete_ns = real_pace_ ? due_ns_ : system_clock().monotonic_ns();
  return Result::kFrame;
}

bool ReplaySource::wait_until_due(const FrameInput& frame, int timeout_ms) {
  const std::int64_t now_ns = system_clock().monotonic_ns();
  if (!pace_started_) {
    pace_started_ = true;
    first_due_ns_ = now_ns;
    first_device_t_s_ = frame.device_t_s;
  }
  due_ns_ = first_due_ns_ + std::llround((frame.device_t_s - first_device_t_s_) * 1e9);
  const std::int64_t until_ns = std::min(due_ns_, now_ns + static_cast<std::int64_t>(timeout_ms) * 1'000'000);
  timespec until{};
  until.tv_sec = until_ns / 1'000'000'000;
  until.tv_nsec = until_ns % 1'000'000'000;
  if (until_ns > now_ns) clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  return system_clock().monotonic_ns() >= due_ns_;
}

}  // namespace st
