// Finding a lost object again: something unexplained of its size has turned up, and it may have turned while
// nobody looked. The model is tried there at many yaws, a few in each frame, and the best is refined; a fixed
// number of tries, so the answer comes after a fixed number of frames.
#pragma once

#include "algo/tracking/associate.hpp"
#include "algo/tracking/birth.hpp"

namespace st {

inline constexpr int kSearchYaws = 36;

struct Search {
  static constexpr int kKept = 3;

  // Within a segment of the object's size; about the last good pose, within a larger one; or in a candidate
  // that may be the object itself.
  enum class Where : std::uint8_t { kSegment, kInPlace, kRival };

  bool running = false;
  Where where = Where::kSegment;
  std::size_t rival = 0;   // that candidate, where == kRival
  std::size_t track = 0;   // which lost track is looked for
  int next_yaw = 0;        // of kSearchYaws; then
  int refined = 0;         // of kKept, one a frame
  int frames_without = 0;  // frames in a row in which the candidate was not there
  Rect box;                // where the candidate was last
  Vec3f centroid{};
  struct Found {
    double score = -1;
    Pose T_anchor_object;  // the candidate may move on until it is refined: relative to where it stands
  } best[kKept];

  void start(std::size_t lost_track, const Unexplained& candidate, Where there);
  void note(double score, const Pose& T_anchor_object);
  const Found& best_of_all() const;
};

// Could the points at this footprint be the lost object? Compares sizes; generous, since only one side is
// seen.
bool size_fits(const Bounds& model, const Bounds& candidate, bool touches_border);

// Which side of a candidate is not in sight: beyond the edge of the view, or behind something nearer.
enum class HiddenSide { kNone, kLeft, kRight };
HiddenSide hidden_side(ImageView<const float> depth_z, ImageView<const std::uint8_t> owners,
                       std::uint8_t owner, const Rect& box, const Rect& view);

// The model set on the candidate's footprint, turned by yaw: where the alignment starts. Of a candidate that
// is narrower than the model, the side in sight is matched.
Pose hypothesis(const Track& track, const Footprint& footprint, const Support& support, double yaw_rad,
                HiddenSide hidden);

// The last good pose turned about the vertical through the model's middle.
Pose turned_in_place(const Track& track, const Support& support, double yaw_rad);

// How well a tried pose fits, 0-1: share of the model that is seen where it should be, of the points near it
// that it explains, and colour where there is one.
double fit_score(const AlignResult& result, const Agreement& agreement);

// Whether a pose found by searching is the object's beyond doubt. Stricter than judge(), which knows that the
// object was nearly there a frame ago.
bool is_found(const AlignResult& result, const Agreement& agreement, const Habit& habit);

}  // namespace st
