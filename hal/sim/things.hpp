// Toys and devices that nobody has built: made up from a number, by the hundred, to be told apart.
#pragma once

#include <cstdint>
#include <string>

#include "hal/sim/surface.hpp"

namespace st::sim {

struct ThingSpec {
  std::uint64_t number = 1;  // of the shape, and of its print
  std::uint64_t print = 0;   // not 0: in the same outline, the bold print of this number
  double scale = 1;          // print and all
  bool mirrored = false;     // left is right
};

// "12", "12:print=7", "12:scale=1.12,mirror". Throws Failure (kBadInput) with what is wrong.
ThingSpec parse_thing(const std::string& text);

// A body of 0.14 to 0.42 m (box, drum, prism, dome or step) with one to four smaller parts on it (towers,
// drums, balls, rings, wedges), plain or printed. Stands on z = 0 with the body's middle over the origin.
Mesh make_thing(const ThingSpec& spec);

// Radius about the origin that holds it, metres.
double radius_of(const Mesh& mesh);

}  // namespace st::sim
