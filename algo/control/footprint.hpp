// Where the turning centre of a robot is to be expected, from its shape alone.
#pragma once

#include <span>

#include "algo/control/base_estimate.hpp"
#include "algo/core/mesh.hpp"

namespace st {

// A robot with a round body turns about the middle of it: that is why it is round. Others are at least alike
// on both sides of their driving direction. Vertices in the object's frame (z up). The widest prior when
// there are too few to tell.
BasePrior footprint_prior(std::span<const MeshVertex> vertices);

}  // namespace st
