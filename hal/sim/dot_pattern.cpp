#include "hal/sim/dot_pattern.hpp"

#include <algorithm>
#include <cmath>

namespace st::sim {

std::vector<float> window_noise(int width, int height, int window, Random& random) {
  const int wide = width + window, tall = height + window;
  std::vector<float> white(static_cast<std::size_t>(wide * tall));
  for (float& x : white) x = static_cast<float>(random.uniform() - 0.5);
  std::vector<float> rows(static_cast<std::size_t>(width * tall)),
      out(static_cast<std::size_t>(width * height));
  for (int v = 0; v < tall; ++v)
    for (int u = 0; u < width; ++u) {
      float sum = 0;
      for (int k = 0; k < window; ++k) sum += white[static_cast<std::size_t>(v * wide + u + k)];
      rows[static_cast<std::size_t>(v * width + u)] = sum;
    }
  const float scale = std::sqrt(12.0f) / static_cast<float>(window);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      float sum = 0;
      for (int k = 0; k < window; ++k) sum += rows[static_cast<std::size_t>((v + k) * width + u)];
      out[static_cast<std::size_t>(v * width + u)] = sum * scale;
    }
  return out;
}

DotPattern make_pattern(int width, int height, int window, double frozen_steps, Random& random) {
  DotPattern pattern;
  pattern.frozen = window_noise(width, height, window, random);
  for (float& x : pattern.frozen) x *= static_cast<float>(frozen_steps);
  pattern.dots.resize(pattern.frozen.size());
  for (float& d : pattern.dots) {  // speckles: few and bright
    const float x = static_cast<float>(random.uniform());
    d = 0.02f + x * x * x * x;
  }
  pattern.hole.assign(pattern.frozen.size(), 0);
  for (int i = 0; i < 14; ++i) {
    const int u = random.below(width), v = random.below(height), r = 1 + random.below(3);
    for (int y = std::max(0, v - r); y <= std::min(height - 1, v + r); ++y)
      for (int x = std::max(0, u - r); x <= std::min(width - 1, u + r); ++x)
        if ((x - u) * (x - u) + (y - v) * (y - v) <= r * r * random.uniform(0.3, 1.3))
          pattern.hole[static_cast<std::size_t>(y * width + x)] = 1;
  }
  return pattern;
}

std::vector<float> make_bias(int width, int height, double peak_steps, Random& random) {
  std::vector<float> bias;
  const double tilt = random.uniform(-1, 1), bowl = random.uniform(-1, 1), twist = random.uniform(-1, 1);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const double x = (u - 0.5 * width) / (0.5 * width), y = (v - 0.5 * height) / (0.5 * height);
      bias.push_back(static_cast<float>(
          peak_steps * (0.3 * tilt * x + 0.5 * bowl * (x * x + y * y - 0.6) + 0.2 * twist * x * y)));
    }
  return bias;
}

}  // namespace st::sim
