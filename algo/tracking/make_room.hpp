// Which track gives way when all slots are taken. What lies wholly in view is what the tracker is for; what
// the view's edge cuts, a person leaning in with arms and legs, may fill every slot and must not cost it one.
#pragma once

#include <cstddef>
#include <span>

#include "algo/tracking/track.hpp"

namespace st {

enum class Newness {
  kCut,       // an unexplained segment at the edge of the view
  kWhole,     // an unexplained segment wholly in view
  kReleased,  // stood there from the start and has just moved: no flicker looks like that
};

// The slot for a newcomer: a free one, or that of the track with the least to lose; tracks.size() when
// everything that is tracked is worth more than it.
std::size_t slot_for(std::span<const Track> tracks, Newness newness);

}  // namespace st
