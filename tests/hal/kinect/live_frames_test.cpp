#include "hal/kinect/live_frames.hpp"

#include <CppUTest/TestHarness.h>

#include <thread>

using namespace st;

TEST_GROUP(LiveFrames) {
  LiveFrames frames;

  void deliver_depth(int k) {
    frames.depth_target()[0] = static_cast<std::uint16_t>(k);
    LiveFrames::Depth frame;
    frame.device_t_s = k;
    frames.depth_done(frame);
  }
  void deliver_color(int k, double device_t_s) {
    frames.color_target()[0] = static_cast<std::uint8_t>(k);
    frames.color_done(device_t_s);
  }
};

TEST(LiveFrames, TheNewestDepthFrameWins) {
  for (int k = 1; k <= 5; ++k) deliver_depth(k);
  const LiveFrames::Depth* frame = frames.newest(0);
  CHECK(frame != nullptr);
  LONGS_EQUAL(5, frame->pixels[0]);
  UNSIGNED_LONGS_EQUAL(5, frame->sequence);
  POINTERS_EQUAL(nullptr, frames.newest(0));
}

TEST(LiveFrames, TheColourTakenIsTheNewestThatIsNotLater) {
  deliver_color(1, 0.5);
  deliver_color(2, 1.5);
  deliver_depth(1);
  const LiveFrames::Depth* frame = frames.newest(0);
  LONGS_EQUAL(1, frames.color_pixels(frame->color)[0]);
  DOUBLES_EQUAL(0.5, frame->color_device_t_s, 0);
}

TEST(LiveFrames, AFrameInHandKeepsItsColourWhateverComes) {
  deliver_color(77, 0.5);
  deliver_depth(1);
  const LiveFrames::Depth* frame = frames.newest(0);
  for (int k = 2; k < 50; ++k) {
    deliver_color(k, k - 0.5);
    if (k % 3 == 0) deliver_depth(k);
    LONGS_EQUAL(77, frames.color_pixels(frame->color)[0]);
    LONGS_EQUAL(1, frame->pixels[0]);
  }
}

TEST(LiveFrames, ReaderAndWriterNeverShareABuffer) {
  constexpr int kFrames = 20'000;
  std::thread writer([this] {
    for (int k = 1; k <= kFrames; ++k) {
      frames.color_target()[0] = frames.color_target()[1] = static_cast<std::uint8_t>(k);
      frames.color_done(k);
      frames.depth_target()[1] = static_cast<std::uint16_t>(k);
      deliver_depth(k);
    }
  });
  std::uint64_t last = 0;
  bool torn = false;
  while (last < kFrames) {
    const LiveFrames::Depth* frame = frames.newest(1000);
    if (frame == nullptr) continue;
    const std::uint8_t* color = frames.color_pixels(frame->color);
    torn = torn || frame->sequence <= last || frame->pixels[0] != frame->pixels[1] || color[0] != color[1];
    torn = torn || frame->pixels[0] != static_cast<std::uint16_t>(frame->sequence) ||
           color[0] != static_cast<std::uint8_t>(frame->sequence);
    last = frame->sequence;
  }
  writer.join();
  CHECK(!torn);
}
