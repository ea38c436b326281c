#include "algo/tracking/make_room.hpp"

namespace st {
namespace {

constexpr int kStands = 30;      // frames without motion
constexpr int kSearchTime = 90;  // frames in which a lost object may be found again before it makes room

// Least to lose first.
enum Worth {
  kCutLost,
  kCutStill,
  kCutCandidate,
  kCutMoving,
  kWholeCandidate,
  kWholeLost,
  kWholeStill,
  kBusy
};

Worth worth_of(const Track& track) {
  const bool still = track.still_run >= kStands;
  switch (track.phase) {
    case Track::Phase::kLost:
      return track.cut() ? kCutLost : track.lost_run > kSearchTime ? kWholeLost : kBusy;
    case Track::Phase::kCandidate:
      return track.cut() ? kCutCandidate : kWholeCandidate;
    default:
      return track.cut() ? (still ? kCutStill : kCutMoving) : still ? kWholeStill : kBusy;
  }
}

bool may_replace(Newness newness, Worth worth) {
  switch (newness) {
    case Newness::kCut:
      return worth <= kCutStill;
    case Newness::kWhole:  // candidates judge themselves in a few frames: turning them out would let none
                           // finish
      return worth != kCutCandidate && worth != kWholeCandidate && worth != kBusy;
    case Newness::kReleased:
      return worth != kBusy;
  }
  return false;
}

// Of two equal in worth: the one of which less was seen, or that has stood still for longer.
bool less_to_lose(const Track& a, const Track& b) {
  if (a.phase == Track::Phase::kLost) return a.good_poses < b.good_poses;
  if (a.still_run != b.still_run) return a.still_run > b.still_run;
  return a.good_poses < b.good_poses;
}

}  // namespace

std::size_t slot_for(std::span<const Track> tracks, Newness newness) {
  std::size_t victim = tracks.size();
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (tracks[k].phase == Track::Phase::kFree) return k;
    const Worth worth = worth_of(tracks[k]);
    if (!may_replace(newness, worth)) continue;
    const Worth least = victim < tracks.size() ? worth_of(tracks[victim]) : kBusy;
    if (worth < least || (worth == least && less_to_lose(tracks[k], tracks[victim]))) victim = k;
  }
  return victim;
}

}  // namespace st
