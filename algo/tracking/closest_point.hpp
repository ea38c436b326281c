// The paper's own alignment: the iterative closest point algorithm, point to point (Besl & McKay 1992; STAR,
// section 4.1, steps 1 to 3), of a segmented frame with the updated model's cloud (Listing 1, lines 2 and 7).
// Every point has a match, however far it is, and nothing but the points' distances counts: what newer terms
// are worth shows beside it.
#pragma once

#include <span>

#include "algo/tracking/align.hpp"
#include "algo/tracking/kd_tree.hpp"
#include "algo/volume/volume.hpp"

namespace st {

struct ClosestPointOptions {
  static constexpr int kMostIterations = 50;

  int iterations = kMostIterations;
  std::size_t points = 2000;  // of the frame, evenly thinned: bounds the time
  // It ends when the mean squared error falls by no more than this share of itself, or below this value.
  double settled_share = 1e-4;
  double settled_m2 = 1e-16;
};

struct ClosestPointResult {
  Pose T_camera_object;
  int iterations = 0;
  // After step 1 of each iteration. It never rises: a fit lowers it, and so do the new closest points.
  double mean_square_m2[ClosestPointOptions::kMostIterations]{};
};

// `observed`: camera frame. `model`: object frame, not empty.
ClosestPointResult closest_point_icp(std::span<const ObservedPoint> observed, const KdTree& model,
                                     const Pose& T_camera_object_start, const ClosestPointOptions& options);

// The model's cloud, kept until the model changes.
struct ModelCloud {
  KdTree tree;

  void bind(Bump& memory) { tree.bind(memory, KdTree::kMostPoints); }
  void take(const Volume& volume);
};

// The same as align() in the loop: starts at in.start and leaves out all terms. What the judge and the motion
// filter ask for (agreement, information, covariance) is what depth says of the pose that was found.
AlignResult align_closest_point(const AlignInput& in, const ModelCloud& model, AlignScratch& scratch);

}  // namespace st
