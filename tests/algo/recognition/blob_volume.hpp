// Volumes of Gaussian blobs: their scale space is known in closed form, and a rotated, scaled or noisy copy
// is computed exactly, not resampled.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "algo/core/pose.hpp"
#include "algo/recognition/sift3d.hpp"
#include "tests/support/bound.hpp"

namespace st::test {

struct Blob {
  Vec3 centre;  // about the middle of the volume, voxels
  Vec3 sigma;   // along the blob's own axes
  Mat3 R{};     // of these
  double height = 1;
};

inline double value_at(const std::vector<Blob>& blobs, const Vec3& p) {
  double sum = 0;
  for (const Blob& blob : blobs) {
    const Vec3 q = blob.R.transposed() * (p - blob.centre);
    double e = 0;
    for (int i = 0; i < 3; ++i) e += q[i] * q[i] / (blob.sigma[i] * blob.sigma[i]);
    sum += blob.height * std::exp(-0.5 * e);
  }
  return sum;
}

// p_copy = scale R p + shift.
struct Copy {
  Mat3 R{};
  double scale = 1;
  Vec3 shift{};
  double noise = 0;
  Vec3 operator()(const Vec3& p) const { return R * p * scale + shift; }
};

inline std::vector<Blob> random_blobs(int count, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  std::vector<Blob> blobs;
  while (static_cast<int>(blobs.size()) < count) {
    Blob blob;
    blob.centre = {uniform(-17, 17), uniform(-17, 17), uniform(-17, 17)};
    blob.sigma = {uniform(1.5, 4), uniform(1.5, 4), uniform(1.5, 4)};
    blob.R = rotation_from_vector({uniform(-2, 2), uniform(-2, 2), uniform(-2, 2)});
    blob.height = uniform(0.4, 1.0);
    if (norm(blob.centre) < 20) blobs.push_back(blob);
  }
  return blobs;
}

// 3-D SIFT with its memory, on a cube of 64 voxels (1 m each) about its middle.
class SiftBench {
 public:
  explicit SiftBench(int side = 64) : memory_([&](Bump& bump) { sift.bind(bump, side); }) {}

  void fill(const std::vector<Blob>& blobs, const Copy& copy = {}) {
    Grid& grid = sift.input();
    const double middle = 0.5 * (grid.side - 1);
    grid.origin_m = to_float(Vec3{-middle, -middle, -middle});
    std::mt19937 random(7);
    std::normal_distribution<double> gauss(0, 1);
    for (int z = 0; z < grid.side; ++z)
      for (int y = 0; y < grid.side; ++y)
        for (int x = 0; x < grid.side; ++x) {
          const Vec3 p{x - middle, y - middle, z - middle};
          const Vec3 original = copy.R.transposed() * (p - copy.shift) * (1 / copy.scale);
          const double noise = copy.noise > 0 ? copy.noise * gauss(random) : 0;
          grid(x, y, z) = static_cast<float>(value_at(blobs, original) + noise);
        }
  }
  const FeatureSet run(const KeypointLimits& limits = {}) {
    sift.start(limits);
    while (!sift.step()) {
    }
    return sift.features();
  }

  Sift3d sift;

 private:
  BoundMemory memory_;
};

}  // namespace st::test
