// What is fixed in a sensor of its own: the projector's pattern with the errors that come with it, and the
// fields that noise is drawn from.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/sim/random.hpp"

namespace st::sim {

// Normal noise of unit variance that is alike within `window` x `window` pixels, as a matching window makes
// it: its correlation falls linearly to nothing at a distance of `window`.
std::vector<float> window_noise(int width, int height, int window, Random& random);

// By place in the pattern, row by row.
struct DotPattern {
  std::vector<float> dots;         // brightness, 0 to 1
  std::vector<float> frozen;       // error of a match that uses these dots, steps
  std::vector<std::uint8_t> hole;  // 1: never matches
};
DotPattern make_pattern(int width, int height, int window, double frozen_steps, Random& random);

// A smooth error over the image (lens, temperature), in steps, at most about `peak_steps`.
std::vector<float> make_bias(int width, int height, double peak_steps, Random& random);

}  // namespace st::sim
