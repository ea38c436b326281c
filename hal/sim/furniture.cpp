#include "hal/sim/furniture.hpp"

#include <cmath>

#include "hal/sim/mesh_builder.hpp"

namespace st::sim {
namespace {

Paint random_paint(Random& random, float low, float high) {
  const auto level = [&] { return static_cast<float>(random.uniform(low, high)); };
  return {level(), level(), level(), static_cast<float>(random.uniform(0.35, 0.65))};
}

float f32(double x) { return static_cast<float>(x); }

}  // namespace

SmoothNoise::SmoothNoise(float period_m, float cell_m, Random& random)
    : cells_(std::max(1, static_cast<int>(period_m / cell_m))),
      scale_(static_cast<float>(cells_) / period_m) {
  values_.resize(static_cast<std::size_t>(cells_ * cells_));
  for (float& v : values_) v = f32(random.uniform());
}

float SmoothNoise::at(float u_m, float v_m) const {
  const float x = u_m * scale_, y = v_m * scale_;
  const float fx = std::floor(x), fy = std::floor(y);
  const auto value = [&](int i, int j) {
    const int a = (static_cast<int>(fx) + i) % cells_, b = (static_cast<int>(fy) + j) % cells_;
    return values_[static_cast<std::size_t>((b + cells_) % cells_ * cells_ + (a + cells_) % cells_)];
  };
  const float s = (x - fx) * (x - fx) * (3 - 2 * (x - fx)), t = (y - fy) * (y - fy) * (3 - 2 * (y - fy));
  return (value(0, 0) * (1 - s) + value(1, 0) * s) * (1 - t) + (value(0, 1) * (1 - s) + value(1, 1) * s) * t;
}

Material floor_material(FloorKind kind, Random& random) {
  const Paint base = mixed({0.55f, 0.53f, 0.48f, 0.45f}, random_paint(random, 0.3f, 0.7f), 0.35f);
  const Paint wood{0.42f, 0.28f, 0.17f, 0.5f}, dark = base * 0.55f;
  const float period = 2.4f, tile = random.uniform() < 0.5 ? 0.30f : 0.40f;
  const SmoothNoise cloud(period, 0.12f, random), grain(period, 0.012f, random), fine(period, 0.006f, random);
  const std::uint64_t salt = random.bits();
  return {Paint{1, 1, 1, 1}, std::make_shared<Texture>(10, period, [&, salt](float u, float v) {
            switch (kind) {
              case FloorKind::kTiles: {
                if (std::fmod(u, tile) < 0.006f || std::fmod(v, tile) < 0.006f) return dark;
                const auto cell =
                    static_cast<std::uint64_t>(u / tile) * 64 + static_cast<std::uint64_t>(v / tile);
                const float own = f32(static_cast<double>(mix64(cell ^ salt) >> 40) / (1 << 24));
                return base * (0.84f + 0.14f * cloud.at(u, v) + 0.06f * fine.at(u, v) + 0.07f * own);
              }
              case FloorKind::kPlanks: {
                const int row = static_cast<int>(u / 0.12f);
                const float shift = 0.37f * static_cast<float>(row % 5), along = std::fmod(v + shift, 1.2f);
                if (std::fmod(u, 0.12f) < 0.003f || along < 0.004f) return wood * 0.45f;
                const float own =
                    f32(static_cast<double>(mix64(static_cast<std::uint64_t>(row) ^ salt) >> 40) / (1 << 24));
                return wood * (0.75f + 0.30f * own + 0.30f * grain.at(u * 4, v * 0.25f));
              }
              case FloorKind::kCarpet:
                return base * (0.35f + 0.55f * fine.at(u, v) + 0.25f * grain.at(u, v));
              case FloorKind::kLinoleum:
                break;
            }
            return base * (0.86f + 0.12f * cloud.at(u, v) + 0.10f * grain.at(u, v));
          })};
}

Material wall_material(Random& random) {
  const Paint base = mixed({0.72f, 0.71f, 0.66f, 0.6f}, random_paint(random, 0.45f, 0.85f), 0.4f);
  const SmoothNoise cloud(2.0f, 0.25f, random), fine(2.0f, 0.01f, random);
  return {Paint{1, 1, 1, 1}, std::make_shared<Texture>(9, 2.0f, [&](float u, float v) {
            return base * (0.92f + 0.06f * cloud.at(u, v) + 0.05f * fine.at(u, v));
          })};
}

Material cardboard_material(Random& random) {
  const SmoothNoise cloud(0.6f, 0.06f, random), fine(0.6f, 0.005f, random);
  const float label_u = f32(random.uniform(0.02, 0.2)), label_v = f32(random.uniform(0.02, 0.12));
  return {
      Paint{1, 1, 1, 1}, std::make_shared<Texture>(8, 0.6f, [&](float u, float v) {
        const float a = u - label_u, b = v - label_v;
        if (a > 0 && a < 0.09f && b > 0 && b < 0.06f)
          return std::fmod(b, 0.012f) < 0.004f && a > 0.01f && a < 0.08f ? Paint{0.1f, 0.1f, 0.1f, 0.2f}
                                                                         : Paint{0.85f, 0.85f, 0.82f, 0.7f};
        return Paint{0.48f, 0.34f, 0.21f, 0.55f} * (0.85f + 0.15f * cloud.at(u, v) + 0.10f * fine.at(u, v));
      })};
}

Mesh make_desk(Random& random) {
  MeshBuilder m;
  const SmoothNoise grain(1.5f, 0.02f, random);
  const Paint wood = mixed({0.40f, 0.26f, 0.15f, 0.5f}, {0.75f, 0.68f, 0.55f, 0.55f}, f32(random.uniform()));
  const std::uint32_t top =
      m.material(Material{Paint{1, 1, 1, 1}, std::make_shared<Texture>(8, 1.5f, [&](float u, float v) {
                            return wood * (0.8f + 0.35f * grain.at(u * 0.2f, v * 2));
                          })});
  const std::uint32_t metal = m.material(Paint{0.33f, 0.35f, 0.38f, 0.30f});
  m.box({-0.35f, -0.70f, 0.70f}, {0.35f, 0.70f, 0.73f}, top);
  m.box({0.30f, -0.66f, 0.38f}, {0.32f, 0.66f, 0.68f}, top);
  for (const float x : {-0.33f, 0.29f})
    for (const float y : {-0.68f, 0.64f}) m.box({x, y, 0}, {x + 0.04f, y + 0.04f, 0.70f}, metal);
  const std::uint32_t screen = m.material(Paint{0.04f, 0.04f, 0.05f, 0.03f});
  m.box({0.05f, -0.25f, 0.83f}, {0.09f, 0.25f, 1.13f}, screen);
  m.box({0.02f, -0.10f, 0.73f}, {0.16f, 0.10f, 0.75f}, screen);
  return m.take();
}

Mesh make_chair(Random& random) {
  MeshBuilder m;
  const std::uint32_t cloth = m.material(random_paint(random, 0.10f, 0.55f));
  const std::uint32_t metal = m.material(Paint{0.06f, 0.06f, 0.06f, 0.09f});
  m.box({-0.22f, -0.22f, 0.42f}, {0.22f, 0.22f, 0.47f}, cloth);
  m.box({-0.24f, -0.21f, 0.52f}, {-0.20f, 0.21f, 0.90f}, cloth);
  for (const float y : {-0.20f, 0.20f}) {
    m.tube({0.20f, y, 0}, {0.18f, y, 0.42f}, 0.014f, 0.014f, 10, metal);
    m.tube({-0.24f, y, 0}, {-0.19f, y, 0.44f}, 0.014f, 0.014f, 10, metal);
    m.tube({-0.19f, y, 0.44f}, {-0.22f, y, 0.88f}, 0.012f, 0.012f, 10, metal);
  }
  return m.take();
}

Mesh make_cardboard_box(float x, float y, float z, Random& random) {
  MeshBuilder m;
  const std::uint32_t card = m.material(cardboard_material(random));
  m.box({-x / 2, -y / 2, 0}, {x / 2, y / 2, z}, card);
  const std::uint32_t tape = m.material(Paint{0.62f, 0.52f, 0.36f, 0.5f});
  m.quad({-x / 2, -0.025f, z + 0.001f}, {x / 2, -0.025f, z + 0.001f}, {x / 2, 0.025f, z + 0.001f},
         {-x / 2, 0.025f, z + 0.001f}, tape);
  return m.take();
}

Mesh make_toy(Random& random) {
  MeshBuilder m;
  const std::uint32_t wall =
      m.material(mixed({0.75f, 0.65f, 0.2f, 0.6f}, random_paint(random, 0.2f, 0.9f), 0.4f));
  const std::uint32_t roof = m.material(Paint{0.60f, 0.12f, 0.10f, 0.55f}),
                      blue = m.material(Paint{0.12f, 0.2f, 0.6f, 0.5f});
  const float x = 0.09f, y = 0.06f, h = 0.08f, ridge = 0.14f;
  m.box({-x, -y, 0}, {x, y, h}, wall);
  m.quad({-x, -y - 0.01f, h - 0.01f}, {x, -y - 0.01f, h - 0.01f}, {x, 0, ridge}, {-x, 0, ridge}, roof);
  m.quad({x, y + 0.01f, h - 0.01f}, {-x, y + 0.01f, h - 0.01f}, {-x, 0, ridge}, {x, 0, ridge}, roof);
  m.quad({x, -y, h}, {x, y, h}, {x, 0, ridge}, {x, 0, ridge}, wall);
  m.quad({-x, y, h}, {-x, -y, h}, {-x, 0, ridge}, {-x, 0, ridge}, wall);
  m.box({0.02f, -0.045f, 0.09f}, {0.05f, -0.015f, 0.165f}, blue);
  m.box({x, -0.015f, 0}, {x + 0.006f, 0.015f, 0.05f}, blue);
  m.box({-0.05f, -y - 0.004f, 0.03f}, {-0.01f, -y, 0.06f}, blue);
  return m.take();
}

Mesh make_poster(Random& random) {
  MeshBuilder m;
  const SmoothNoise blobs(1.0f, 0.11f, random), blobs2(1.0f, 0.09f, random);
  const std::uint32_t print =
      m.material(Material{Paint{1, 1, 1, 1}, std::make_shared<Texture>(8, 1.0f, [&](float u, float v) {
                            const float a = blobs.at(u, v), b = blobs2.at(u, v);
                            return Paint{0.2f + 0.6f * a, 0.25f + 0.5f * b, 0.6f - 0.4f * a, 0.55f};
                          })});
  m.quad({0, 0.4f, -0.3f}, {0, -0.4f, -0.3f}, {0, -0.4f, 0.3f}, {0, 0.4f, 0.3f}, print);
  return m.take();
}

Mesh make_thigh(const Paint& trousers) {
  MeshBuilder m;
  const std::uint32_t cloth = m.material(trousers);
  m.tube({0, 0, -0.03f}, {0, 0, 0.50f}, 0.068f, 0.090f, 20, cloth);
  return m.take();
}

Mesh make_shin(const Paint& trousers) {
  MeshBuilder m;
  const std::uint32_t cloth = m.material(trousers), shoe = m.material(Paint{0.08f, 0.07f, 0.07f, 0.20f});
  m.tube({0, 0, 0.05f}, {0, 0, 0.50f}, 0.060f, 0.067f, 20, cloth);
  m.box({-0.07f, -0.045f, 0}, {0.19f, 0.045f, 0.05f}, shoe);
  m.box({-0.07f, -0.042f, 0.05f}, {0.08f, 0.042f, 0.09f}, shoe);
  return m.take();
}

Mesh make_torso(const Paint& shirt) {
  MeshBuilder m;
  const std::uint32_t cloth = m.material(shirt);
  m.tube({0, 0, -0.06f}, {0, 0, 0.55f}, 0.165f, 0.19f, 24, cloth);
  return m.take();
}

Mesh make_arm(const Paint& sleeve) {
  MeshBuilder m;
  const std::uint32_t skin = m.material(Paint{0.62f, 0.43f, 0.34f, 0.55f}), cloth = m.material(sleeve);
  m.box({-0.06f, -0.042f, 0}, {0.035f, 0.042f, 0.028f}, skin);
  for (int finger = 0; finger < 4; ++finger) {
    const float y = -0.033f + 0.022f * static_cast<float>(finger);
    m.tube({0.03f, y, 0.015f}, {0.10f, y, -0.015f}, 0.010f, 0.008f, 8, skin);
  }
  m.tube({-0.03f, 0.04f, 0.012f}, {0.03f, 0.075f, -0.01f}, 0.011f, 0.009f, 8, skin);
  m.tube({-0.05f, 0, 0.015f}, {-0.20f, 0, 0.10f}, 0.028f, 0.036f, 14, skin);
  m.tube({-0.18f, 0, 0.09f}, {-0.62f, 0, 0.44f}, 0.045f, 0.062f, 16, cloth);
  m.tube({-0.60f, 0, 0.42f}, {-0.92f, 0.06f, 0.66f}, 0.062f, 0.075f, 16, cloth);
  // Whoever it belongs to, bent over; what is below the floor nobody sees.
  m.tube({-1.10f, 0.20f, -1.2f}, {-0.95f, 0.20f, 0.74f}, 0.17f, 0.19f, 24, cloth);
  m.tube({-0.93f, 0.20f, 0.76f}, {-0.84f, 0.20f, 0.98f}, 0.085f, 0.095f, 16, skin);
  return m.take();
}

}  // namespace st::sim
