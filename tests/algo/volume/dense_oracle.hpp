// The update rule of integrate(), voxel by voxel over the whole volume in plain scalar code: what skipping
// bricks and vector kernels must not change by a single bit.
#pragma once

#include <cmath>

#include "algo/volume/evidence.hpp"
#include "tests/algo/volume/analytic_view.hpp"

namespace st::test {

struct DenseOracle {
  explicit DenseOracle(const Volume& like) {
    volume = like;
    tsdf.assign(like.tsdf.begin(), like.tsdf.end());
    weight.assign(like.weight.begin(), like.weight.end());
    observations.assign(like.observations.begin(), like.observations.end());
    color.assign(like.color.begin(), like.color.end());
    bricks.assign(like.bricks.begin(), like.bricks.end());
    octants.assign(like.octants.begin(), like.octants.end());
    volume.tsdf = tsdf;
    volume.weight = weight;
    volume.observations = observations;
    volume.color = color;
    volume.bricks = bricks;
  }

  // `evidence` is what integrate() computed for this frame.
  void fuse(const View& view, const Evidence& evidence, const IntegrateOptions& o) {
    const PoseF T = to_float(view.T_camera_object);
    const Vec3f first = T * volume.origin;
    const float m = volume.voxel_m;
    for (int c = 0; c < 3; ++c) {
      const double x = 0.5 + 0.61803398874989485 * static_cast<double>(volume.integrations) + c / 3.0;
      dither[c] = static_cast<float>(0.999 * (x - std::floor(x)));
    }
    std::vector<std::uint8_t> solid = bricks;
    for (int z = 0; z < volume.side; ++z)
      for (int y = 0; y < volume.side; ++y)
        for (int x = 0; x < volume.side; ++x) {
          Vec3f p;
          for (int a = 0; a < 3; ++a)
            p[a] = (((first[a] + T.R(a, 2) * m * static_cast<float>(z)) +
                     T.R(a, 1) * m * static_cast<float>(y)) +
                    T.R(a, 0) * m * static_cast<float>(x / 8 * 8)) +
                   static_cast<float>(x % 8) * (T.R(a, 0) * m);
          const bool carve = (solid[volume.brick_index(x / 8, y / 8, z / 8)] & kBrickSolid) != 0;
          voxel(volume.index(x, y, z), p, view, evidence, o, carve);
        }
    for (std::size_t b = 0; b < bricks.size(); ++b) bricks[b] = octants[b] = 0;
    for (int z = 0; z < volume.side; ++z)
      for (int y = 0; y < volume.side; ++y)
        for (int x = 0; x < volume.side; ++x) {
          const std::int16_t s = tsdf[volume.index(x, y, z)];
          if (s == kUnseen) continue;
          std::uint8_t& flags = bricks[volume.brick_index(x / 8, y / 8, z / 8)];
          flags = static_cast<std::uint8_t>(flags | kBrickTouched | (s < 0 ? kBrickSolid : 0));
          if (s >= 0) continue;
          std::uint8_t& parts = octants[volume.brick_index(x / 8, y / 8, z / 8)];
          parts = static_cast<std::uint8_t>(parts | 1 << ((x / 4 & 1) + 2 * (y / 4 & 1) + 4 * (z / 4 & 1)));
        }
    ++volume.integrations;
  }

  Volume volume;
  std::vector<std::int16_t> tsdf;
  std::vector<std::uint8_t> weight, observations, bricks, octants;
  std::vector<std::uint32_t> color;

 private:
  void voxel(std::size_t at, const Vec3f& p, const View& view, const Evidence& e, const IntegrateOptions& o,
             bool carve) {
    if (!(p.z > 0.05f)) return;
    const float cx = view.camera.cx - static_cast<float>(e.roi.u0),
                cy = view.camera.cy - static_cast<float>(e.roi.v0);
    const float per_z = 1.0f / p.z;
    const float u = view.camera.fx * p.x * per_z + (cx + 0.5f),
                v = view.camera.fy * p.y * per_z + (cy + 0.5f);
    if (!(u >= 0 && v >= 0 && u < static_cast<float>(e.roi.width()) &&
          v < static_cast<float>(e.roi.height())))
      return;
    const int iu = static_cast<int>(u), iv = static_cast<int>(v);
    const std::size_t pixel =
        static_cast<std::size_t>(iv) * static_cast<std::size_t>(e.stride) + static_cast<std::size_t>(iu);
    const float depth = e.z[pixel], ahead = depth - p.z;
    const float reach = 1.5f * volume.truncation_m;
    if (!(depth > 0) || !(ahead > -reach)) return;
    const std::uint32_t meta = e.meta[pixel];
    const float nx = static_cast<float>(static_cast<std::int32_t>(meta << 22) >> 22) * (1.0f / 511.0f);
    const float ny = static_cast<float>(static_cast<std::int32_t>(meta << 12) >> 22) * (1.0f / 511.0f);
    const float minus_nz = std::sqrt(std::fmax(1.0f - (nx * nx + ny * ny), 0.0f));
    const float ex = p.x - (static_cast<float>(iu) - cx) * (1.0f / view.camera.fx) * depth;
    const float ey = p.y - (static_cast<float>(iv) - cy) * (1.0f / view.camera.fy) * depth;
    const float t = (nx * ex + ny * ey + minus_nz * ahead) * (1.0f / volume.truncation_m);
    const bool near = (meta & kEvidenceSurface) != 0 && std::fabs(t) < 1 && ahead < reach;
    const bool seen = tsdf[at] != kUnseen;
    const bool emptied =
        carve && (meta & kEvidenceFree) != 0 && t >= 1 && ahead > 0 && seen && tsdf[at] < 31128;
    if (!near && !emptied) return;
    update(at, t, near, static_cast<float>((meta >> 20) & 255u) * (1.0f / 16.0f), o);
    const float band = std::fmax(1.5f * volume.voxel_m * (1.0f / volume.truncation_m), 0.25f);
    if (near && (meta & kEvidenceColor) != 0 && std::fabs(t) < band && !view.color.empty())
      paint(at, view.color[static_cast<std::size_t>((iv + e.roi.v0) * view.camera.width + iu + e.roi.u0)], o);
  }

  void update(std::size_t at, float t, bool near, float sample_weight, const IntegrateOptions& o) {
    const bool seen = tsdf[at] != kUnseen;
    const float old = seen ? static_cast<float>(tsdf[at]) * (1.0f / 32767.0f) : 0.0f;
    const float held = seen ? static_cast<float>(weight[at]) * 0.5f : 0.0f;
    const float w = near ? sample_weight * std::fmin(1.0f, (1.0f + t) / 0.5f) : o.carve_weight;
    const float mean = old + w * ((near ? t : 1.0f) - old) / std::fmax(held + w, 1e-6f);
    tsdf[at] = static_cast<std::int16_t>(std::nearbyint(std::fmin(std::fmax(mean, -1.0f), 1.0f) * 32767.0f));
    const float sum = near ? std::fmin(held + w, o.weight_cap) : held - w;
    weight[at] =
        static_cast<std::uint8_t>(std::fmin(std::fmax(sum * 2.0f + dither[0], 1.0f), o.weight_cap * 2.0f));
    if (near && observations[at] < 255) ++observations[at];
  }

  void paint(std::size_t at, std::uint32_t sample, const IntegrateOptions& o) {
    if (alpha_of(sample) == 0) return;
    const std::uint32_t old = color[at];
    const float trust = static_cast<float>(color_trust_of(old)), spread = color_sigma_of(old);
    float difference[3], square = 0;
    for (int c = 0; c < 3; ++c) {
      difference[c] =
          static_cast<float>((sample >> (8 * c)) & 255u) - static_cast<float>((old >> (8 * c)) & 255u);
      square += difference[c] * difference[c];
    }
    square /= 3.0f;
    const bool agrees = trust == 0 || square <= 9.0f * (spread * spread);
    const float gain = agrees ? 1.0f / (trust * trust * 0.4f + 1.0f) : 0.0f;
    std::uint32_t word = 0;
    for (int c = 0; c < 3; ++c)
      word |= static_cast<std::uint32_t>(static_cast<float>((old >> (8 * c)) & 255u) + gain * difference[c] +
                                         dither[c])
              << (8 * c);
    const float next = trust == 0 ? 24.0f : spread + gain * (std::sqrt(square) * 1.15f - spread);
    const float steps = std::fmin(std::fmax(next / 3.0f - 1.0f + dither[0], 0.0f), 15.0f);
    const float next_trust = agrees ? std::fmin(trust + 1, o.color_cap) : std::fmax(trust - 1, 0.0f);
    color[at] =
        word | (static_cast<std::uint32_t>(steps) << 24) | (static_cast<std::uint32_t>(next_trust) << 28);
  }

  float dither[3] = {};
};

}  // namespace st::test
