#include "tests/replay/driven_circle.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "hal/sim/sim_recording.hpp"

namespace st::test {
namespace {

namespace fs = std::filesystem;

constexpr double kSeconds = 3.6;  // the robot sets off at 1.5
constexpr double kScanSeconds = 3.0;

void halve(Intrinsics& k) {
  k.width /= 2;
  k.height /= 2;
  k.fx /= 2;
  k.fy /= 2;
  k.cx = (k.cx + 0.5) / 2 - 0.5;
  k.cy = (k.cy + 0.5) / 2 - 0.5;
}

void record(const char* name, double seconds, const std::string& folder) {
  sim::SceneOptions options;
  options.name = name;
  options.seconds = seconds;
  sim::Scene scene = sim::make_scene(options);
  halve(scene.calibration.depth);
  halve(scene.calibration.color);
  const Intrinsics& depth = scene.calibration.depth;
  scene.depth.camera = {static_cast<float>(depth.fx),
                        static_cast<float>(depth.fy),
                        static_cast<float>(depth.cx),
                        static_cast<float>(depth.cy),
                        depth.width,
                        depth.height};
  sim::CameraRig rig(std::move(scene));
  const std::atomic<bool> stop{false};
  sim::write_recording(rig, folder, stop, [](std::uint64_t, std::uint64_t) {});
}

std::string last_depth_frame(const fs::path& folder) {
  std::string last;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("d-") && name > last) last = name;
  }
  return last;
}

struct Recording {
  Recording(const char* scene, double seconds) { record(scene, seconds, folder.path()); }
  TempFolder folder;
};

// No reading anywhere: 2047, as the sensor says it when something stands right before it.
std::string dark_frame() {
  std::string dark = "P5 320 240 65535\n";
  for (int i = 0; i < 320 * 240; ++i) dark += std::string("\xff\x07", 2);
  return dark;
}

}  // namespace

const std::string& driven_circle() {
  static const Recording recording("circle", kSeconds);
  return recording.folder.path();
}

const std::string& hand_scan() {
  static const Recording recording("scan", kScanSeconds);
  return recording.folder.path();
}

void scan_covered_between(const std::string& folder, std::size_t from, std::size_t to) {
  fs::copy(hand_scan(), folder, fs::copy_options::recursive);
  std::vector<fs::path> frames;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().starts_with("d-")) frames.push_back(entry.path());
  std::sort(frames.begin(), frames.end());
  for (std::size_t i = from; i < to; ++i) std::ofstream(frames.at(i), std::ios::binary) << dark_frame();
}

void driven_then_covered(const std::string& folder) {
  fs::copy(driven_circle(), folder, fs::copy_options::recursive);
  const std::string last = last_depth_frame(folder);
  double host_s = 0;
  unsigned ticks = 0;
  std::sscanf(last.c_str(), "d-%lf-%u", &host_s, &ticks);
  std::ofstream index(folder + "/INDEX.txt", std::ios::app);
  const std::string dark = dark_frame();
  for (unsigned k = 1; k <= 40; ++k) {
    char name[64];
    std::snprintf(name, sizeof name, "d-%.6f-%u.pgm", host_s + k / 30.0,
                  ticks + k * static_cast<unsigned>(sim::kDepthPeriod_ticks));
    std::ofstream(folder + "/" + name, std::ios::binary) << dark;
    index << name << '\n';
  }
}

}  // namespace st::test
