// Where a live camera's frames land and the loop picks them up: newest depth frame wins, those it replaces
// are counted. Triple buffer for depth, a small pool for colour; the device writes straight into them. One
// writer, one reader, no lock.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "algo/core/calibration.hpp"
#include "algo/core/linear.hpp"
#include "hal/source/semaphore.hpp"

namespace st {

class LiveFrames {
 public:
  struct Depth {
    std::vector<std::uint16_t> pixels;
    std::uint64_t sequence = 0;  // from 1
    double t_s = 0, device_t_s = 0;
    std::int64_t complete_ns = 0;
    int color = -1;  // index of the colour buffer taken with it
    std::uint64_t color_sequence = 0;
    double color_device_t_s = 0;
    bool has_gravity = false;
    Vec3 up_mps2{};
    std::uint64_t lost_packets = 0;  // USB packets lost up to this frame, in all
  };

  LiveFrames();

  // Writer: where the device puts what comes next.
  std::uint16_t* depth_target() { return depths_[back_].pixels.data(); }
  std::uint8_t* color_target() { return colors_[static_cast<std::size_t>(color_target_)].data(); }
  // Writer: the colour target is complete; another one is chosen.
  void color_done(double device_t_s);
  // Writer: the frame in depth_target() is complete; `frame` tells everything but pixels, sequence and
  // colour. The colour taken is the newest not later than it.
  void depth_done(const Depth& frame);
  void wake() { arrived_.post(); }

  // Reader: the newest frame, which holds until the next call; null on timeout or when woken without one.
  const Depth* newest(int timeout_ms);
  const std::uint8_t* color_pixels(int index) const {
    return colors_[static_cast<std::size_t>(index)].data();
  }

 private:
  // Being written, the two newest complete ones, and one held by each depth frame that the reader has or may
  // take.
  static constexpr int kColorBuffers = 5;
  static constexpr unsigned kFresh = 4;  // flag in middle_: not yet taken by the reader

  struct ColorStamp {
    int buffer = -1;
    std::uint64_t sequence = 0;
    double device_t_s = 0;
  };
  int free_color_buffer() const;

  std::array<Depth, 3> depths_;
  std::array<std::vector<std::uint8_t>, kColorBuffers> colors_;
  std::array<ColorStamp, 2> newest_colors_;  // newest first; writer's
  int color_target_ = 0;
  std::uint64_t depth_sequence_ = 0, color_sequence_ = 0;
  unsigned back_ = 0;                // writer's
  std::atomic<unsigned> middle_{1};  // index, and kFresh
  unsigned front_ = 2;               // reader's
  Semaphore arrived_{0};
};

}  // namespace st
