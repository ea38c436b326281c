// A triangle mesh on memory that the caller owns.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/linear.hpp"

namespace st {

struct MeshVertex {
  Vec3f position{};  // metres, object (or world) frame
  Vec3f normal{};    // unit, outwards
  std::uint8_t r = 0, g = 0, b = 0;
  std::uint16_t observations = 0;
};

struct MeshView {
  std::span<const MeshVertex> vertices;
  std::span<const std::uint32_t> indices;  // three a triangle, counter-clockwise seen from outside
};

}  // namespace st
