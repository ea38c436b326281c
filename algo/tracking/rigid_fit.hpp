// The rigid motion that moves one set of points onto another with the least mean squared error (Horn 1987,
// closed form with unit quaternions). Sums are added pair by pair, so that no list of pairs is kept.
#pragma once

#include "algo/core/pose.hpp"

namespace st {

class RigidFit {
 public:
  // A point and the one that it belongs to.
  void add(const Vec3& from, const Vec3& to);

  int pairs() const { return pairs_; }
  // Motion with to = motion * from; false with fewer than three pairs. Where the points leave a turn open
  // (all on one line) it is any of those that fit.
  bool solve(Pose& motion) const;

 private:
  int pairs_ = 0;
  Vec3 from_{}, to_{};  // sums
  double cross_[9]{};   // sums of from * to^T
};

}  // namespace st
