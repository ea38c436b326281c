#include "algo/segmentation/grow.hpp"

namespace st {
namespace {

constexpr int kAhead = 9 * Background::kUnit;
constexpr int kNeighbours = 3;

bool joins(std::uint8_t label, int u, int v, const Background& background,
           ImageView<const std::uint16_t> code, ImageView<const std::uint8_t> labels) {
  if (labels(u, v) != 0 || background.classes()(u, v) != static_cast<std::uint8_t>(PixelClass::kSame))
    return false;
  if (code(u, v) * Background::kUnit < background.code8()(u, v) + kAhead) return false;
  int beside = 0;
  for (int j = v - 1; j <= v + 1; ++j)
    for (int i = u - 1; i <= u + 1; ++i) beside += labels(i, j) == label ? 1 : 0;
  return beside >= kNeighbours;
}

}  // namespace

int grow_label(std::uint8_t label, const Rect& box, const Background& background,
               ImageView<const std::uint16_t> code, ImageView<std::uint8_t> labels) {
  const Rect all{1, 1, code.width - 1, code.height - 1}, wide = box.grown(2);
  const Rect in{wide.u0 > all.u0 ? wide.u0 : all.u0, wide.v0 > all.v0 ? wide.v0 : all.v0,
                wide.u1 < all.u1 ? wide.u1 : all.u1, wide.v1 < all.v1 ? wide.v1 : all.v1};
  if (in.width() * in.height() > code.pixels() / 8) return 0;
  int joined = 0;
  for (int v = in.v0; v < in.v1; ++v)
    for (int u = in.u0; u < in.u1; ++u)
      if (joins(label, u, v, background, code, labels)) labels(u, v) = label, ++joined;
  for (int v = in.v1 - 1; v >= in.v0; --v)
    for (int u = in.u1 - 1; u >= in.u0; --u)
      if (joins(label, u, v, background, code, labels)) labels(u, v) = label, ++joined;
  return joined;
}

}  // namespace st
