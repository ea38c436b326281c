// Finding a lost object again: something unexplained of its size has turned up, and it may have turned while
// nobody looked. The model is tried there at many yaws, a few in each frame, and the best is refined; a fixed
// number of tries, so the answer comes after a fixed number of frames.
#pragma once

#include "algo/tracking/associate.hpp"
#include "algo/tracking/birth.hpp"

namespace st {

inline constexpr int kSearchYaws = 24;

struct Search {
  static constexpr int kKept = 2;

  bool running = false;
  std::size_t track = 0;   // which lost track is looked for
  int next_yaw = 0;        // of kSearchYaws
  int frames_without = 0;  // frames in a row in which the candidate was not there
  Rect box;                // where the candidate was last
  Vec3f centroid{};
  struct Found {
    double score = -1;
    double yaw_rad = 0;  // about the floor's up axis, from the object's first orientation
  } best[kKept];

  void start(std::size_t lost_track, const Unexplained& candidate);
  void note(double score, double yaw_rad);
};

// Could the points at this footprint be the lost object? Compares sizes; generous, since only one side is
// seen.
bool size_fits(const Bounds& model, const Bounds& candidate, bool touches_border);

// The model set on the candidate's footprint, turned by yaw: where the alignment starts.
Pose hypothesis(const Track& track, const Footprint& footprint, const Support& support, double yaw_rad);

// How well a tried pose fits, 0-1: agreement in depth, and in colour where there is one.
double fit_score(const AlignResult& result, const Agreement& agreement);

}  // namespace st
