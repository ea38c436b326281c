// The motion between two upright things from matched features: gravity leaves a turn about z and a shift, so
// that two matches fix it, and every pair of matches can be tried.
#pragma once

#include "algo/core/pose.hpp"
#include "algo/recognition/match.hpp"

namespace st {

struct UprightFit {
  bool found = false;
  Pose T_b_a;       // p_b = T_b_a p_a; a turn about z and a shift
  int inliers = 0;  // matches that agree
};

// Most matches that are paired up: the nearest ones; 1,128 pairs.
inline constexpr std::size_t kPairedMatches = 48;

// tolerance_m: how far a matched feature may lie from where it should be. Found: at least three agree.
// Consensus over all pairs (RANSAC, Fischler and Bolles 1981, with nothing left to chance), then least
// squares over those that agree.
UprightFit fit_upright(const FeatureSet& a, const FeatureSet& b, const Matches& matches, float tolerance_m);

}  // namespace st
