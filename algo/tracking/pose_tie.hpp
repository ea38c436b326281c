// Equations about a pose that is not quite the one sought, but tied to it: of another instant, or read from
// something that may be off. What the tie leaves open is a nuisance, and is marginalised out.
#pragma once

#include "algo/core/pose.hpp"
#include "algo/tracking/normal_equations.hpp"

namespace st {

// Per axis of a frame, position and then turn: a deviation d of the pose sought means share * d + e of the
// other one, e ~ N(0, sigma^2) (m, rad). As it stands the two are the same.
struct PoseTie {
  Mat3 R_frame_camera;
  double share[6] = {1, 1, 1, 1, 1, 1};
  double sigma[6]{};
};

// What the equations say of e, per axis: its mean if the pose sought is the one they were taken at, how that
// changes with an error of it, and the variance once that is known.
struct TieRest {
  bool told = false;  // false: there were no such equations
  double mean[6]{}, slope[6]{}, variance[6]{};
};

// Adds `eq`, which is about the other pose, to the equations of the one sought. Both in camera axes.
TieRest add_tied(const NormalEquations& eq, const PoseTie& tie, NormalEquations& into);

// The deviation of the other pose for that of the one sought, both in camera axes; `e` per axis of the frame.
Twist tied_deviation(const PoseTie& tie, const Twist& deviation, const double (&e)[6]);

}  // namespace st
