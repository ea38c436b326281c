#include "hal/sim/sim_recording.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "hal/error.hpp"
#include "hal/sim/truth_files.hpp"

namespace st::sim {
namespace {

constexpr double kCountsPerG = 819.0, kGravity_mps2 = 9.80665;

struct Stamp {
  double host_s = 0;
  std::uint32_t ticks = 0;
};

// Host stamps come late by the transfer and by what else the host did, and never out of order.
class HostClock {
 public:
  HostClock(const Scene& scene) : random_(scene.seed, 0x4057), jitter_s_(scene.host_jitter_s) {
    epoch_s_ = 1'400'000'000.0 + static_cast<double>(scene.seed % 100'000) * 1000.0;
    // Every third Kinect is about to wrap its 32-bit counter.
    const double lead_s = scene.seed % 3 == 0 ? random_.uniform(1, 6) : random_.uniform(20, 70);
    first_tick_ = static_cast<std::uint32_t>((std::int64_t{1} << 32) -
                                             static_cast<std::int64_t>(lead_s * kTickRate_hz));
  }
  Stamp at(std::int64_t ticks_since_start) {
    double late = std::min(0.012, jitter_s_ * std::fabs(random_.normal()));
    if (random_.uniform() < 0.02) late += random_.uniform(0.002, 0.008);
    const double host = epoch_s_ + static_cast<double>(ticks_since_start) / kTickRate_hz + 0.030 + late;
    last_s_ = std::max(host, last_s_ + 2e-6);
    return {last_s_, first_tick_ + static_cast<std::uint32_t>(ticks_since_start)};
  }
  // Seconds of the camera's clock, wraps undone.
  double device_s(std::int64_t ticks_since_start) const {
    return (static_cast<double>(first_tick_) + static_cast<double>(ticks_since_start)) / kTickRate_hz;
  }

 private:
  Random random_;
  double jitter_s_, epoch_s_ = 0, last_s_ = 0;
  std::uint32_t first_tick_ = 0;
};

class FakenectFolder {
 public:
  explicit FakenectFolder(const std::string& folder) : folder_(folder), index_(folder + "/INDEX.txt") {}

  void add(char type, const char* extension, const Stamp& stamp, const char* header, const void* data,
           std::size_t bytes) {
    char name[96];
    std::snprintf(name, sizeof name, "%c-%.6f-%u.%s", type, stamp.host_s, stamp.ticks, extension);
    TextFile file(folder_ + "/" + name);
    file.write(header, std::strlen(header));
    file.write(data, bytes);
    file.close();
    index_.print("%s\n", name);
  }
  void close() { index_.close(); }

 private:
  std::string folder_;
  TextFile index_;
};

// struct freenect_raw_tilt_state: its axes are the optical frame's turned half about x.
void add_tilt(FakenectFolder& out, const Stamp& stamp, const Vec3& up_mps2, Random& random) {
  std::uint8_t state[12]{};
  const double axis[3] = {up_mps2.x, -up_mps2.y, -up_mps2.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto counts =
        static_cast<std::int16_t>(std::lround(axis[i] * kCountsPerG / kGravity_mps2 + 2.0 * random.normal()));
    std::memcpy(state + 2 * i, &counts, 2);
  }
  out.add('a', "dump", {stamp.host_s + 1e-6, stamp.ticks}, "", state, sizeof state);
}

bool written_by_simulate(const std::string& name) {
  const auto is = [&](const char* prefix, const char* suffix) {
    const std::size_t p = std::strlen(prefix), s = std::strlen(suffix);
    return name.size() >= p + s && name.compare(0, p, prefix) == 0 &&
           name.compare(name.size() - s, s, suffix) == 0;
  };
  return is("d-", ".pgm") || is("r-", ".ppm") || is("a-", ".dump") || is("truth", ".tum") ||
         is("truth", ".ply") || name == "INDEX.txt" || name == "camera.toml" || name == "visible.csv" ||
         name == "path.csv";
}

}  // namespace

Vec3 gravity_reading(const Scene& scene, double t_s) {
  // Zero offsets of the sensor: a good half degree.
  Random random(scene.seed, 0xacce1);
  const Vec3 offset{0.08 * random.normal(), 0.08 * random.normal(), 0.08 * random.normal()};
  const Pose T_camera_room = scene.camera_at(t_s);
  Vec3 push_mps2{};
  if (scene.camera_motion) {
    constexpr double kStep_s = 0.01;
    const auto eye = [&](double t) { return scene.camera_at(t).inverse().t; };
    push_mps2 = (eye(t_s + kStep_s) - eye(t_s) * 2.0 + eye(t_s - kStep_s)) * (1 / (kStep_s * kStep_s));
  }
  return T_camera_room.R * (push_mps2 + Vec3{0, 0, kGravity_mps2}) + offset;
}

bool clear_recording(const std::string& folder) {
  namespace fs = std::filesystem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (written_by_simulate(entry.path().filename().string())) fs::remove(entry.path());
  return fs::is_empty(folder);
}

std::uint64_t write_recording(CameraRig& rig, const std::string& folder, const std::atomic<bool>& stop,
                              const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
  const Scene& scene = rig.scene();
  const Intrinsics &kd = scene.calibration.depth, &kc = scene.calibration.color;
  write_camera_file(scene.calibration, folder + "/camera.toml");
  write_preset(scene, folder + "/path.csv");
  write_true_shapes(scene, folder);
  TruthFiles truth(scene, folder);
  FakenectFolder out(folder);
  HostClock clock(scene);
  Random random(scene.seed, 0x7117);
  const auto total =
      static_cast<std::uint64_t>(scene.duration_s * kTickRate_hz / static_cast<double>(kDepthPeriod_ticks));
  const auto color_offset = static_cast<std::int64_t>(random.uniform(0.008, 0.013) * kTickRate_hz);
  std::vector<std::uint16_t> raw(static_cast<std::size_t>(kd.width * kd.height));
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(3 * kc.width * kc.height));
  const ImageView<std::uint16_t> depth{raw.data(), kd.width, kd.height};
  char depth_header[64], color_header[64];
  std::snprintf(depth_header, sizeof depth_header, "P5 %d %d 65535\n", kd.width, kd.height);
  std::snprintf(color_header, sizeof color_header, "P6 %d %d 255\n", kc.width, kc.height);

  std::uint64_t written = 0, colors = 0;
  for (; written < total && !stop.load(); ++written) {
    const std::int64_t ticks = static_cast<std::int64_t>(written) * kDepthPeriod_ticks;
    // Colour frames that were exposed before this depth frame.
    for (std::int64_t c = 0;
         (c = color_offset + static_cast<std::int64_t>(colors) * kColorPeriod_ticks) < ticks; ++colors) {
      rig.color_frame(static_cast<double>(c) / kTickRate_hz, colors, rgb.data());
      out.add('r', "ppm", clock.at(c), color_header, rgb.data(), rgb.size());
    }
    const double t_s = static_cast<double>(ticks) / kTickRate_hz;
    rig.depth_frame(t_s, written, depth);
    const Stamp stamp = clock.at(ticks);
    out.add('d', "pgm", stamp, depth_header, raw.data(), 2 * raw.size());
    add_tilt(out, stamp, gravity_reading(scene, t_s), random);
    truth.add(t_s, {stamp.host_s, clock.device_s(ticks), stamp.ticks, written}, rig.visibility(depth), depth);
    progress(written + 1, total);
  }
  out.close();
  truth.close();
  return written;
}

}  // namespace st::sim
