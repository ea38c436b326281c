// Which features of two things belong together: each the other's nearest, and clearly nearer than the next
// (Lowe 2004, section 7.1).
#pragma once

#include "algo/core/fixed_vector.hpp"
#include "algo/recognition/sift3d.hpp"

namespace st {

inline constexpr float kMatchRatio = 0.85f;  // of the nearest distance to the next

struct Match {
  int a = 0, b = 0;  // features
  std::uint32_t squared_distance = 0;
};
using Matches = FixedVector<Match, kMaxFeatures>;

// The matching of one thing with another in slices of one row: row(i) is done for every feature of `a`, then
// finish() keeps the mutual ones.
class Matcher {
 public:
  void bind(Bump& memory);
  void start(const FeatureSet& a, const FeatureSet& b);
  // Compares the next feature of `a` with all of `b`. True when it was the last.
  bool step();
  void finish(float ratio, Matches& matches) const;

 private:
  // Nearest feature of the other side, and the distance of the nearest that belongs to another keypoint.
  struct Nearest {
    int feature = -1;
    std::uint32_t distance = 0, next = 0;
    void see(int other, std::uint32_t d, std::span<const Feature> others);
    bool is_clear(float ratio) const;
  };
  FeatureSet a_, b_;
  std::span<Nearest> of_a_, of_b_;
  std::size_t next_ = 0;
};

}  // namespace st
