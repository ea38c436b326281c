// What stands, lies and walks about in a lab. Each mesh stands on z = 0 at its origin unless it says
// otherwise.
#pragma once

#include "hal/sim/random.hpp"
#include "hal/sim/surface.hpp"

namespace st::sim {

// Value noise in [0, 1], smooth over `cell_m`, repeating every `period_m`.
class SmoothNoise {
 public:
  SmoothNoise(float period_m, float cell_m, Random& random);
  float at(float u_m, float v_m) const;

 private:
  int cells_;
  float scale_;
  std::vector<float> values_;
};

enum class FloorKind { kTiles, kPlanks, kCarpet, kLinoleum };
Material floor_material(FloorKind kind, Random& random);
Material wall_material(Random& random);
Material cardboard_material(Random& random);

Mesh make_desk(Random& random);   // 1.4 x 0.7 m, 0.73 m high, long side along y
Mesh make_chair(Random& random);  // seat 0.45 m, looks along +x
Mesh make_cardboard_box(float x_m, float y_m, float z_m, Random& random);
Mesh make_toy(Random& random);     // a coloured house with a chimney, 0.18 m long
Mesh make_poster(Random& random);  // 0.8 x 0.6 m, in the plane x = 0, seen from -x, centre at its origin
Mesh make_thigh(const Paint& trousers);  // from the knee (origin) up along z, 0.5 m
Mesh make_shin(
    const Paint& trousers);  // from the ankle's height 0 at its foot to the knee at z = 0.48; shoe along +x
Mesh make_torso(const Paint& shirt);  // from the hips (origin) up, 0.55 m
Mesh make_arm(const Paint& sleeve);   // hand at the origin (palm down), arm and its owner away along -x

}  // namespace st::sim
