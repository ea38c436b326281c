// What simulated things are made of: triangles, and textures that carry colour and infrared reflectivity
// apart.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "algo/core/linear.hpp"

namespace st::sim {

// Linear reflectance, 0 to 1. `ir`: at the projector's 830 nm, where dyes are often bright and glossy black
// plastic is not.
struct Paint {
  float r = 0.5f, g = 0.5f, b = 0.5f, ir = 0.5f;

  constexpr Paint operator*(float s) const { return {r * s, g * s, b * s, ir * s}; }
};
constexpr Paint mixed(const Paint& a, const Paint& b, float share_b) {
  const float s = 1 - share_b;
  return {a.r * s + b.r * share_b, a.g * s + b.g * share_b, a.b * s + b.b * share_b,
          a.ir * s + b.ir * share_b};
}

// A square picture that repeats every `period_m` metres, with its smaller copies.
class Texture {
 public:
  // `paint_at(u_m, v_m)` is asked at every texel; side is 2^side_log2 texels.
  Texture(int side_log2, float period_m, const std::function<Paint(float, float)>& paint_at);

  // The texel at (u, v) metres, from the copy whose texels are about `footprint_m` wide. Packed r, g, b, ir
  // (low byte first).
  std::uint32_t at(float u_m, float v_m, float footprint_m) const;

 private:
  int side_log2_;
  float texels_per_m_;
  std::vector<std::vector<std::uint32_t>> levels_;
};

struct Material {
  Paint paint{};                           // times the texture, where there is one
  std::shared_ptr<const Texture> texture;  // null: plain
};

struct Vertex {
  Vec3f position{}, normal{};
  float u = 0, v = 0;  // metres on the texture
};

struct Face {
  std::uint32_t a = 0, b = 0, c = 0;  // counter-clockwise seen from outside
  std::uint32_t material = 0;
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<Face> faces;
  std::vector<Material> materials;
};

}  // namespace st::sim
