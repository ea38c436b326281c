#include "algo/depth/pyramid.hpp"

#include "algo/depth/pyramid_kernel.hpp"

namespace st {
namespace {

constexpr std::size_t kPad = 16;  // elements behind the last pixel that wide loads may read

// Without a table: the rule is linear, and vectorises.
std::uint32_t scale(const std::uint16_t* __restrict stored, float* __restrict z, int count,
                    float metres_per_step) {
  std::uint32_t valid_pixels = 0;
  for (int i = 0; i < count; ++i) {
    const float m = static_cast<float>(stored[i]) * metres_per_step;
    const bool valid =
        stored[i] != 65535 && m >= static_cast<float>(kNearest_m) && m <= static_cast<float>(kFarthest_m);
    z[i] = valid ? m : 0.0f;
    valid_pixels += valid ? 1u : 0u;
  }
  return static_cast<std::uint32_t>(count) - valid_pixels;
}

std::uint32_t triangulate(const std::uint16_t* __restrict stored, float* __restrict z, int count,
                          const Calibration& c, int first, int last) {
  const auto a = static_cast<float>(c.raw_a), b = static_cast<float>(c.raw_b);
  std::uint32_t valid_pixels = 0;
  for (int i = 0; i < count; ++i) {
    const int raw = stored[i];
    const bool valid = raw >= first && raw <= last;
    const float m = a / (b - static_cast<float>(raw));
    z[i] = valid ? m : 0.0f;
    valid_pixels += valid ? 1u : 0u;
  }
  return static_cast<std::uint32_t>(count) - valid_pixels;
}

std::uint32_t undistort(const DepthTables& tables, const std::uint16_t* stored, float* z, int count) {
  const auto remap = tables.remap();
  const auto metres = tables.z_of_stored();
  std::uint32_t invalid = 0;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t from = remap[static_cast<std::size_t>(i)];
    const std::size_t value = from == DepthTables::kNoSource ? metres.size() : stored[from];
    z[i] = value < metres.size() ? metres[value] : 0.0f;
    invalid += z[i] > 0 ? 0u : 1u;
  }
  return invalid;
}

// 1 / z grows by the correction. Returns the readings that are out of range by it.
std::uint32_t correct(const std::int16_t* __restrict correction, float* __restrict z, int count,
                      float inverse_m) {
  constexpr auto kNear = static_cast<float>(kNearest_m), kFar = static_cast<float>(kFarthest_m);
  std::uint32_t lost_pixels = 0;
  for (int i = 0; i < count; ++i) {
    const float m = z[i] / (1.0f + z[i] * inverse_m * static_cast<float>(correction[i]));
    const bool kept = m >= kNear && m <= kFar;
    lost_pixels += z[i] > 0.0f && !kept ? 1u : 0u;
    z[i] = kept ? m : 0.0f;
  }
  return lost_pixels;
}

}  // namespace

void DepthPyramid::bind(Bump& memory, const Pinhole& camera) {
  for (int i = 0; i < kLevels; ++i) {
    Level& level = levels[i];
    level.camera = i == 0 ? camera : coarser(levels[i - 1].camera, 2);
    const auto pixels =
        static_cast<std::size_t>(level.camera.width) * static_cast<std::size_t>(level.camera.height);
    level.z = {memory.take<float>(pixels + kPad).data(), level.camera.width, level.camera.height};
  }
}

std::uint32_t fill_pyramid(const DepthTables& tables, ImageView<const std::uint16_t> stored,
                           DepthPyramid& pyramid) {
  const ImageView<float>& z = pyramid.levels[0].z;
  const int count = z.pixels();
  std::uint32_t invalid = static_cast<std::uint32_t>(count);
  if (stored.empty() || stored.width != z.width || stored.height != z.height) {
    for (int i = 0; i < count; ++i) z.data[i] = 0;
  } else if (!tables.remap().empty()) {
    invalid = undistort(tables, stored.data, z.data, count);
  } else if (tables.calibration().encoding == DepthEncoding::kScaled16) {
    invalid = scale(stored.data, z.data, count, static_cast<float>(1.0 / tables.calibration().depth_scale));
  } else {
    invalid =
        triangulate(stored.data, z.data, count, tables.calibration(), tables.raw_first(), tables.raw_last());
  }
  if (!tables.correction().empty())
    invalid += correct(tables.correction().data(), z.data, count,
                       static_cast<float>(1.0 / tables.codes_per_inverse_m()));
  for (int i = 1; i < DepthPyramid::kLevels; ++i) {
    const ImageView<float>&fine = pyramid.levels[i - 1].z, &coarse = pyramid.levels[i].z;
    halve_depth(fine.data, fine.width, coarse.data, coarse.width, coarse.height);
  }
  return invalid;
}

}  // namespace st
