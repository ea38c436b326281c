// A turn of several degrees in one frame, after frames that were dropped or when somebody nudges it, is
// beyond what colour leads back from: the print lies beside itself, and the alignment settles in between. The
// residuals of the colours tell; then headings beside the predicted one are tried.
#pragma once

#include "algo/tracking/align.hpp"
#include "algo/tracking/judge.hpp"

namespace st {

// Colour and shape together, so that two alignments of one frame can be compared; 0: none.
double look_score(const AlignResult& result);

// Where the colours of `result`, the alignment of `in`, fit worse than they usually do: tries headings up to
// kBesideReach_rad to both sides about `up` (unit, camera frame) and takes the best over, if its colours fit
// as they usually do. Returns whether it did; `turn` is then how far about `up` the prediction was off.
inline constexpr double kBesideReach_rad = 0.21;
bool align_beside(const AlignInput& in, const Habit& habit, const Vec3& up, AlignScratch& scratch,
                  AlignResult& result, Mat3& turn);

}  // namespace st
