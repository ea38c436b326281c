// Small recordings made up for tests, and a source read to its end.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/source/frame_source.hpp"

namespace st::test {

inline constexpr int kWidth = 8, kHeight = 4;  // of made-up frames; their camera.toml says so

// One made-up depth frame: every pixel holds `value`.
std::string pgm(int value, int width = kWidth, int height = kHeight);
std::string ppm(int value, int width = kWidth, int height = kHeight);
std::string png_gray16(int value, int width = kWidth, int height = kHeight);
std::string png_gray8(int value, int width = kWidth, int height = kHeight);
std::string png_rgb8(int value, int width = kWidth, int height = kHeight);

// Frame k of a Kinect at 30 Hz whose counter starts at `first_ticks`.
double host_of(int k);
std::uint32_t ticks_of(int k, std::uint32_t first_ticks = 1000);

void write_camera_toml(const std::string& folder, bool color);
// Appends a depth / colour frame of value `value` with the stamps of frame k.
void add_depth(const std::string& folder, int k, int value, std::uint32_t first_ticks = 1000);
void add_color(const std::string& folder, int k, int value, std::uint32_t first_ticks = 1000);
void add_named(const std::string& folder, const std::string& name, const std::string& content);

// A frame as a test wants to look at it later.
struct SeenFrame {
  FrameInput input;  // its views are empty
  std::vector<std::uint16_t> depth;
  std::vector<std::uint8_t> color;
};
struct Seen {
  std::vector<SeenFrame> frames;
  SourceInfo info;
  FrameSource::Result end = FrameSource::Result::kTimeout;

  std::vector<Event> events(EventKind kind) const;
};
Seen read_all(FrameSource& source);
Seen read_all(const std::string& folder, const std::string& camera_file = "");

// The line of the Failure that opening throws; empty when it opens.
std::string why_not(const std::string& spec, const std::string& camera_file = "");

}  // namespace st::test
