#include "algo/core/calibration.hpp"
#include "hal/recording/png_image.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/fake_recording.hpp"

using namespace st;
using namespace st::fuzz;

ST_FUZZ(png, st::test::png_gray16(1234), st::test::png_gray8(7), st::test::png_rgb8(99),
        st::test::png_gray16(1, 641, 2)) {
  static std::vector<std::uint16_t> depth(static_cast<std::size_t>(kMaxWidth) * kMaxHeight);
  static std::vector<std::uint8_t> color(3 * depth.size());
  for (const ImageVerdict& verdict : {decode_png_depth(data, depth), decode_png_color(data, color)}) {
    require(verdict.ok == verdict.what.empty(), "a reason, or none");
    if (verdict.ok) require(verdict.width <= kMaxWidth && verdict.height <= kMaxHeight, "a size that fits");
  }
}
