#include "algo/segmentation/background_kernels.hpp"

namespace st::background_kernels {
namespace {

// Minima, maxima, products and masks only: the compiler turns comparisons in such loops into branches.
constexpr std::uint16_t kThird = 21845;  // 2^16 / 3
constexpr std::uint16_t kRise = 24, kFall = 1;

std::uint16_t one_if_any(std::uint16_t x) { return x < 1 ? x : std::uint16_t{1}; }
std::uint16_t beyond(std::uint16_t x, std::uint16_t limit) {
  return static_cast<std::uint16_t>((x > limit ? x : limit) - limit);
}
// All ones for 1, zero for 0.
std::uint16_t mask(std::uint16_t one) { return static_cast<std::uint16_t>(0 - one); }

}  // namespace

void classify(const std::uint16_t* __restrict code, const std::uint16_t* __restrict mean,
              const std::uint16_t* __restrict tolerance, std::uint8_t* __restrict out, int width) {
  for (int u = 0; u < width; ++u) {
    const auto q = static_cast<std::uint16_t>(code[u] * kUnit);
    const std::uint16_t m = mean[u], t = tolerance[u];
    const std::uint16_t top = q > m ? q : m;
    const std::uint16_t nearer = one_if_any(beyond(static_cast<std::uint16_t>(top - m), t));
    const std::uint16_t farther = one_if_any(beyond(static_cast<std::uint16_t>(top - q), t));
    const std::uint16_t known = one_if_any(m), reading = one_if_any(q);
    // 1 without a reading, else 3 without a background, else 5 nearer, 2 farther, 0 neither.
    const auto beside = static_cast<std::uint16_t>(5 * nearer + 2 * farther);
    const auto there = static_cast<std::uint16_t>(known * beside + 3 * (1 - known));
    out[u] = static_cast<std::uint8_t>(reading * there + (1 - reading));
  }
}

void drift(const std::uint16_t* __restrict code, const std::uint8_t* __restrict kind,
           const std::uint8_t* __restrict owner, std::uint16_t* __restrict mean,
           std::uint16_t* __restrict tolerance, int width, std::uint16_t step_factor) {
  for (int u = 0; u < width; ++u) {
    const auto q = static_cast<std::uint16_t>(code[u] * kUnit);
    const std::uint16_t m = mean[u], t = tolerance[u];
    const auto stopped = static_cast<std::uint16_t>(kind[u] | owner[u]);
    const std::uint16_t may = mask(static_cast<std::uint16_t>(static_cast<std::uint16_t>(stopped - 1) >> 15));
    const std::uint16_t top = q > m ? q : m;
    const auto above = static_cast<std::uint16_t>(top - m), below = static_cast<std::uint16_t>(top - q);
    mean[u] = static_cast<std::uint16_t>(m + (one_if_any(above) & may) - (one_if_any(below) & may));
    const auto off = static_cast<std::uint16_t>(above | below);  // one of them is zero
    const std::uint16_t least = least_tolerance(m, step_factor);
    const std::uint16_t rise = off > high(t, kThird) ? kRise : std::uint16_t{0};
    const std::uint16_t fall = t > least ? kFall : std::uint16_t{0};
    const auto next = static_cast<std::uint16_t>(t + (rise & may) - (fall & may));
    tolerance[u] = next < kMostTolerance ? next : kMostTolerance;
  }
}

void learn(const std::uint16_t* __restrict code, std::uint16_t* __restrict mean,
           std::uint16_t* __restrict spread, std::uint8_t* __restrict count, std::uint8_t* __restrict changes,
           std::uint8_t* __restrict out, int width, std::uint16_t weight, std::uint16_t step_factor) {
  for (int u = 0; u < width; ++u) {
    const auto q = static_cast<std::uint16_t>(code[u] * kUnit);
    const std::uint16_t m = mean[u], s = spread[u], top = q > m ? q : m;
    const auto above = static_cast<std::uint16_t>(top - m), below = static_cast<std::uint16_t>(top - q);
    const auto off = static_cast<std::uint16_t>(above | below);
    const auto gate = static_cast<std::uint16_t>(2 * least_tolerance(q, step_factor));
    const std::uint16_t reading = one_if_any(q), known = one_if_any(m);
    const auto other = static_cast<std::uint16_t>(one_if_any(beyond(off, gate)) * known * reading);
    const auto agrees = static_cast<std::uint16_t>(reading * (1 - other));
    const std::uint16_t step_mask = mask(static_cast<std::uint16_t>(agrees * known));
    const std::uint16_t start_mask = mask(static_cast<std::uint16_t>(agrees * (1 - known)));
    const auto step = static_cast<std::uint16_t>(high(above, weight) - high(below, weight));
    mean[u] = static_cast<std::uint16_t>(m + (step & step_mask) + (q & start_mask));
    const auto grown = static_cast<std::uint16_t>(off & step_mask);
    spread[u] = s > grown ? s : grown;
    count[u] = static_cast<std::uint8_t>(count[u] + agrees);
    const std::uint16_t c = changes[u];
    const auto turned = static_cast<std::uint16_t>((c & 0x7F) + (c >> 7));
    changes[u] =
        static_cast<std::uint8_t>((turned & mask(agrees)) | (c & static_cast<std::uint16_t>(~mask(agrees))));
    out[u] = static_cast<std::uint8_t>((1 - reading) + 2 * other);
  }
}

}  // namespace st::background_kernels
