#include "algo/depth/preprocess.hpp"

namespace st {
namespace {

// Vectorises: the raw encoding is linear in codes.
std::uint32_t convert_raw(const DepthTables& tables, const std::uint16_t* stored, std::uint16_t* code,
                          int count) {
  const auto origin = static_cast<std::uint16_t>(tables.raw_origin());
  const auto first = static_cast<std::uint16_t>(tables.raw_first());
  const auto span = static_cast<std::uint16_t>(tables.raw_last() - tables.raw_first());
  std::uint32_t valid_pixels = 0;
  for (int i = 0; i < count; ++i) {
    const std::uint16_t raw = stored[i];
    const auto past_first =
        static_cast<std::uint16_t>(raw - first);  // wraps below `first`, and so fails the test
    const bool valid = past_first <= span;
    code[i] = valid ? static_cast<std::uint16_t>(origin - 8 * raw) : std::uint16_t{0};
    valid_pixels += valid ? 1u : 0u;
  }
  return static_cast<std::uint32_t>(count) - valid_pixels;
}

std::uint32_t convert_by_table(const DepthTables& tables, const std::uint16_t* stored, std::uint16_t* code,
                               int count) {
  const auto table = tables.code_of_stored();
  const std::size_t last = table.size() - 1;
  std::uint32_t invalid = 0;
  for (int i = 0; i < count; ++i) {
    const std::size_t at = stored[i];
    code[i] = at <= last ? table[at] : std::uint16_t{0};
    invalid += code[i] == 0 ? 1u : 0u;
  }
  return invalid;
}

// Returns the readings that are out of range by it.
std::uint32_t correct(const DepthTables& tables, std::uint16_t* __restrict code, int count) {
  const std::int16_t* __restrict correction = tables.correction().data();
  const double k = tables.codes_per_inverse_m(), offset = tables.code_offset();
  const int least = static_cast<int>(k / kFarthest_m - offset) + 1;
  const int nearest = static_cast<int>(k / kNearest_m - offset),
            most = nearest < kCodes ? nearest : kCodes - 1;
  std::uint32_t lost_pixels = 0;
  for (int i = 0; i < count; ++i) {
    const int moved = code[i] + correction[i];
    const bool kept = code[i] != 0 && moved >= least && moved <= most;
    lost_pixels += code[i] != 0 && !kept ? 1u : 0u;
    code[i] = kept ? static_cast<std::uint16_t>(moved) : std::uint16_t{0};
  }
  return lost_pixels;
}

}  // namespace

CleanDepth preprocess(const DepthTables& tables, ImageView<const std::uint16_t> depth,
                      ImageView<std::uint16_t> code, ImageView<std::uint16_t> stored) {
  const int count = code.pixels();
  CleanDepth out{code, depth, 0};
  if (depth.empty() || depth.width != code.width || depth.height != code.height) {
    for (int i = 0; i < count; ++i) code.data[i] = 0;
    out.invalid_pixels = static_cast<std::uint32_t>(count);
    out.stored = {};
    return out;
  }
  const auto remap = tables.remap();
  if (!remap.empty()) {
    const bool raw = tables.calibration().encoding == DepthEncoding::kRaw11;
    const std::uint16_t nothing = raw ? std::uint16_t{2047} : std::uint16_t{0};
    for (int i = 0; i < count; ++i) {
      const std::uint32_t from = remap[static_cast<std::size_t>(i)];
      stored.data[i] = from == DepthTables::kNoSource ? nothing : depth.data[from];
    }
    out.stored = stored;
  }
  const bool linear = tables.raw_last() >= tables.raw_first();  // raw encoding, and some value in range
  out.invalid_pixels = linear ? convert_raw(tables, out.stored.data, code.data, count)
                              : convert_by_table(tables, out.stored.data, code.data, count);
  if (!tables.correction().empty()) out.invalid_pixels += correct(tables, code.data, count);
  return out;
}

void to_metres(const DepthTables& tables, ImageView<const std::uint16_t> code, ImageView<float> z_m) {
  const auto k = static_cast<float>(tables.codes_per_inverse_m());
  const auto offset = static_cast<float>(tables.code_offset());
  const std::uint16_t* __restrict in = code.data;
  float* __restrict out = z_m.data;
  const int pixels = code.pixels();
  for (int i = 0; i < pixels; ++i) {
    const float z = k / (static_cast<float>(in[i]) + offset);
    out[i] = in[i] == 0 ? 0.0f : z;
  }
}

}  // namespace st
