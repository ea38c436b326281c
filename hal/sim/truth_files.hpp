// The files of ground truth that stand beside a simulated recording.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "hal/sim/camera_rig.hpp"

namespace st::sim {

// A file that says when it cannot be written: Failure (kBadInput), also where the disk is full.
class TextFile {
 public:
  explicit TextFile(const std::string& path);
  ~TextFile();
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void print(const char* format, ...) __attribute__((format(printf, 2, 3)));
  void close();

 private:
  [[noreturn]] void fail() const;

  std::string path_;
  std::FILE* file_;
};

struct FrameStamp {
  double host_s = 0, device_s = 0;
  std::uint32_t ticks = 0;
  std::uint64_t frame = 0;
};

void write_camera_file(const Calibration& calibration, const std::string& path);
// `t,x,y,yaw,v,w` from the robot's start, x forward; nothing is written where the scene has no robot.
void write_preset(const Scene& scene, const std::string& path);
// truth.ply, or truth-N.ply for several: binary, in the object's frame, with normals and colours. Of a scene
// that a hand-held camera sees: the room.
void write_true_shapes(const Scene& scene, const std::string& folder);

// truth.tum (truth-N.tum for several objects; of a hand-held camera: T_room_camera) and visible.csv, a line
// per depth frame.
class TruthFiles {
 public:
  TruthFiles(const Scene& scene, const std::string& folder);
  void add(double t_s, const FrameStamp& stamp, const std::vector<Visibility>& seen,
           ImageView<const std::uint16_t> raw);
  void close();

 private:
  const Scene& scene_;
  std::vector<std::unique_ptr<TextFile>> poses_;
  TextFile visible_;
};

}  // namespace st::sim
