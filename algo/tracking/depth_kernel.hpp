// The vector part of add_depth_term(): plain arrays, see depth_term.hpp for meanings.
#pragma once

#include "algo/tracking/pairing.hpp"

namespace st {

struct DepthKernel {
  Pairing pairing;
  float gate2_m2, robust2;  // robust_sigmas squared
  float information;        // of one point, of a whole measurement's
  // Results, added to.
  double triangle[21]{}, gradient[6]{};
  double square_sum = 0;  // of the inliers, m^2
  int paired = 0, inliers = 0;
};

void accumulate_depth(DepthKernel& work);

}  // namespace st
