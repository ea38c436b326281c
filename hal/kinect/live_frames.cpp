#include "hal/kinect/live_frames.hpp"

namespace st {

LiveFrames::LiveFrames() {
  constexpr std::size_t kPixels = static_cast<std::size_t>(kMaxWidth) * kMaxHeight;
  for (Depth& depth : depths_) depth.pixels.resize(kPixels);
  for (auto& color : colors_) color.resize(3 * kPixels);
}

int LiveFrames::free_color_buffer() const {
  // The reader swaps front and middle at any time, but the two together are always the slots other than back;
  // their `color` is written by this thread only.
  for (int i = 0; i < kColorBuffers; ++i) {
    bool used = i == newest_colors_[0].buffer || i == newest_colors_[1].buffer;
    for (unsigned d = 0; d < 3; ++d) used = used || (d != back_ && depths_[d].color == i);
    if (!used) return i;
  }
  return 0;  // cannot be: at most four are in use
}

void LiveFrames::color_done(double device_t_s) {
  newest_colors_[1] = newest_colors_[0];
  newest_colors_[0] = {color_target_, ++color_sequence_, device_t_s};
  color_target_ = free_color_buffer();
}

void LiveFrames::depth_done(const Depth& frame) {
  Depth& slot = depths_[back_];
  slot.sequence = ++depth_sequence_;
  slot.t_s = frame.t_s;
  slot.device_t_s = frame.device_t_s;
  slot.complete_ns = frame.complete_ns;
  slot.has_gravity = frame.has_gravity;
  slot.up_mps2 = frame.up_mps2;
  slot.lost_packets = frame.lost_packets;
  slot.color = -1;
  for (const ColorStamp& color : newest_colors_) {
    if (color.buffer < 0 || color.device_t_s > frame.device_t_s) continue;
    slot.color = color.buffer;
    slot.color_sequence = color.sequence;
    slot.color_device_t_s = color.device_t_s;
    break;
  }
  back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & ~kFresh;
  arrived_.post();
}

const LiveFrames::Depth* LiveFrames::newest(int timeout_ms) {
  if (!arrived_.wait_for(timeout_ms)) return nullptr;
  while (arrived_.try_wait()) {
  }
  if ((middle_.load(std::memory_order_acquire) & kFresh) == 0) return nullptr;
  front_ = middle_.exchange(front_, std::memory_order_acq_rel) & ~kFresh;
  return &depths_[front_];
}

}  // namespace st
