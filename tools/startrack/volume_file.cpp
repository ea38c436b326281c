#include "tools/startrack/volume_file.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>

#include "algo/recognition/sift3d.hpp"
#include "firmware_like/heap_memory.hpp"
#include "hal/error.hpp"
#include "hal/results/line_file.hpp"

namespace st {
namespace {

int side_of(std::size_t bytes, const std::string& name) {
  for (const int side : {32, 64, 128, 256}) {
    const auto n = static_cast<std::size_t>(side);
    if (bytes == n * n * n * sizeof(float)) return side;
  }
  throw Failure(ExitCode::kBadInput,
                name + ": has " + std::to_string(bytes) +
                    " bytes; needed is a cube of float32 with 32, 64, 128 or 256 a side");
}

// As SIFT takes it: the largest magnitude is 1, so that the contrast limits mean the same for every file.
void load(const std::string& bytes, const std::string& name, const Grid& grid) {
  std::memcpy(grid.values.data(), bytes.data(), bytes.size());
  float most = 0;
  for (const float v : grid.values) {
    if (!std::isfinite(v)) throw Failure(ExitCode::kBadInput, name + ": holds values that are no numbers");
    most = std::fabs(v) > most ? std::fabs(v) : most;
  }
  if (most > 0)
    for (float& v : grid.values) v /= most;
}

}  // namespace

void print_keypoints(const std::string& volume, const std::string& descriptors) {
  const std::string bytes = read_whole_file(volume);
  const int side = side_of(bytes.size(), volume);
  Sift3d sift;
  const HeapMemory memory([&](Bump& bump) { sift.bind(bump, side); });
  load(bytes, volume, sift.input());
  sift.start();
  while (!sift.step()) {
  }
  const FeatureSet set = sift.features();
  std::printf("keypoint,octave,x,y,z,sigma,contrast,r00,r01,r02,r10,r11,r12,r20,r21,r22\n");
  std::string out;
  for (std::size_t i = 0; i < set.features.size(); ++i) {
    const Feature& f = set.features[i];
    const Keypoint& k = sift.keypoints()[static_cast<std::size_t>(f.keypoint)];
    std::printf("%d,%d,%.3f,%.3f,%.3f,%.3f,%.5f", f.keypoint, k.octave, static_cast<double>(f.p_m.x),
                static_cast<double>(f.p_m.y), static_cast<double>(f.p_m.z), static_cast<double>(f.sigma_m),
                static_cast<double>(k.contrast));
    for (const float m : f.R.m) std::printf(",%.5f", static_cast<double>(m));
    std::printf("\n");
    for (const std::uint8_t element : set.descriptors[i].bytes) {
      const float value = static_cast<float>(element) / kByteScale;
      out.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
  const KeypointCounts& c = sift.counts();
  std::fprintf(stderr,
               "startrack: %d extrema; %d of too little contrast, %d flat, %d crowded out; %zu keypoints, "
               "%zu features\n",
               c.extrema, c.low_contrast, c.flat, c.crowded_out, sift.keypoints().size(),
               set.features.size());
  if (!descriptors.empty()) write_whole_file(descriptors, out);
}

}  // namespace st
