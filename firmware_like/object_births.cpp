// How a track begins: from something that stood there and has begun to move, or from a segment that no track
// explains.
#include "algo/tracking/image_box.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

// Frames in which an unexplained segment must stand before it becomes a track: single-frame flicker begins
// nothing.
constexpr int kNewcomerFrames = 2;
constexpr double kLeastNewcomer_m2 = 0.002;

}  // namespace

void ObjectTracker::claim_pixels(const Unexplained& what, std::size_t k) {
  for (int v = what.box.v0; v < what.box.v1; ++v)
    for (int u = what.box.u0; u < what.box.u1; ++u)
      if (segmentation_->labels(u, v) == what.label && frame_.owners(u, v) == kForeign)
        frame_.owners(u, v) = static_cast<std::uint8_t>(k + 1);
}

void ObjectTracker::claim_near(const Unexplained& what, std::size_t k, const Vec3& centre, double radius_m) {
  const Vec3f c = to_float(centre);
  const auto radius = static_cast<float>(radius_m);
  for (int v = what.box.v0; v < what.box.v1; ++v) {
    for (int u = what.box.u0; u < what.box.u1; ++u) {
      if (segmentation_->labels(u, v) != what.label || frame_.owners(u, v) != kForeign) continue;
      const Vec3f p = frame_.camera.ray(static_cast<float>(u), static_cast<float>(v)) * frame_.depth_z(u, v);
      if (norm(p - c) < radius) frame_.owners(u, v) = static_cast<std::uint8_t>(k + 1);
    }
  }
}

// What the released thing looked like at rest, into rest_z_.
void ObjectTracker::fill_rest(const Rect& box) {
  const std::span<const float> z_of_code = segmenter_.tables().z_of_code();
  const ImageView<const std::uint16_t> code = segmentation_->released_code;
  for (int i = 0; i < rest_z_.pixels(); ++i) rest_z_.data[i] = 0;
  for (int v = box.v0; v < box.v1; ++v)
    for (int u = box.u0; u < box.u1; ++u) rest_z_(u, v) = z_of_code[code(u, v)];
}

// The edge that moved first may have begun a track of its own, which now gives way to the whole.
void ObjectTracker::drop_fragments(const Rect& box) {
  constexpr int kYoung = 15;  // good poses
  for (Track& track : tracks_) {
    if (!track.active() || track.good_poses >= kYoung || track.from_background) continue;
    const auto model_z = [&](int u, int v) { return track.view.z(u, v); };
    if (3 * count_same_surface(model_z, rest_z_, box, 0.04f) > track.view_pixels) evict(track);
  }
}

bool ObjectTracker::in_arena(const Vec3& p_camera) const {
  if (config_.arena.empty()) return true;
  const Vec3 p = support_.R_camera_floor.transposed() * p_camera;
  return is_inside({config_.arena.begin(), config_.arena.size()}, p.x, p.y);
}

// Something that stood there from the first frame has just begun to move. What it looked like at rest,
// averaged over the learning frames, is the best first frame there is, and no hand touched it yet.
void ObjectTracker::begin_released() {
  if (!segmentation_->has_released || !in_arena(to_double(segmentation_->released.centroid_m))) return;
  const ReleasedProto& released = segmentation_->released;
  const Rect box = released.box.clipped(rest_z_.width, rest_z_.height);
  fill_rest(box);
  drop_fragments(box);
  const std::size_t k = make_room(Newness::kReleased);
  if (k == kMaxObjects) return;
  const std::span<ObservedPoint> points = points_of(k);
  const int every = released.pixels / static_cast<int>(points.size()) + 1;
  std::size_t used = 0;
  int seen = 0;
  for (int v = box.v0; v < box.v1; ++v) {
    for (int u = box.u0; u < box.u1; ++u) {
      if (!(rest_z_(u, v) > 0) || seen++ % every != 0) continue;
      points[used].p = frame_.camera.ray(static_cast<float>(u), static_cast<float>(v)) * rest_z_(u, v);
      ++used;
    }
  }
  if (used < kLeastPoints) return;
  Track& track = tracks_[k];
  start_track(track, find_footprint(points.first(used), support_), support_, frame_.input->device_t_s);
  track.from_background = true;
  track.has_moved = true;
  fuse_at_rest(track, box);
  // Pixels of the thing in this frame are its own already, so that no second track starts from them.
  for (std::size_t i = 0; i < unexplained_.size();) {
    if (!overlap(unexplained_[i].box, box)) {
      ++i;
      continue;
    }
    if (segmentation_->segments[unexplained_[i].label - 1u].from_background) claim_pixels(unexplained_[i], k);
    unexplained_.erase(i);
  }
}

// False: it has to wait for a slot, or is not worth one.
bool ObjectTracker::begin_from_pixels(const Unexplained& what) {
  // Ragged things are hardly more than edges: nobody makes room for them.
  if (!in_arena(to_double(what.centroid))) return false;
  const int solid =
      count_solid(frame_.depth_z, frame_.owners, kForeign, segmentation_->labels, what.label, what.box);
  if (solid < kLeastPoints) return false;
  const std::size_t k = make_room(what.touches_border ? Newness::kCut : Newness::kWhole);
  if (k == kMaxObjects) return false;
  Track& track = tracks_[k];
  claim_pixels(what, k);
  track.aligned = AlignResult{};  // how it moves is not known
  observe(track, k, what.box);
  if (track.points_used < kLeastPoints) return false;
  start_track(track, find_footprint(points_of(k).first(track.points_used), support_), support_,
              frame_.input->device_t_s);
  fuse(track, k);
  return true;
}

ObjectTracker::Newcomer* ObjectTracker::newcomer_at(const Rect& box) {
  for (Newcomer& newcomer : newcomers_)
    if (overlap(newcomer.box, box)) return &newcomer;
  return nullptr;
}

// Whether an object that is lost, or about to be, is looked for where it was, in a segment that hides its
// size.
bool ObjectTracker::is_looked_for_in(const Unexplained& what) const {
  constexpr int kLookedFor = 24;  // frames: two searches
  if (!what.touches_border) return false;
  for (const Track& track : tracks_) {
    const bool failing = track.phase == Track::Phase::kTracked && track.poor_run > 0;
    const bool lost = track.phase == Track::Phase::kLost && track.lost_run < kLookedFor;
    if (!(failing || lost) || track.cut()) continue;
    if (overlap(image_box(track.bounds, track.T_last_good, frame_.camera, 0), what.box)) return true;
  }
  return false;
}

// Ragged things (the legs of a chair) and limbs begin tracks that come to nothing; the next from the same
// place has to wait, or they would take turns for ever.
void ObjectTracker::mark_barren(const Track& track) {
  constexpr int kWait = 90;  // frames
  if (barren_.full()) barren_.erase(0);
  barren_.push_back({image_box(track.bounds, track.T_camera_object, frame_.camera, 0), kWait});
}

bool ObjectTracker::is_barren(const Unexplained& what) const {
  for (const Barren& place : barren_)
    if (overlap(place.box, what.box) &&
        4 * what.box.width() * what.box.height() < 9 * place.box.width() * place.box.height())
      return true;
  return false;
}

void ObjectTracker::begin_tracks() {
  for (std::size_t i = 0; i < barren_.size();) {
    if (--barren_[i].frames_left > 0)
      ++i;
    else
      barren_.erase(i);
  }
  for (Newcomer& newcomer : newcomers_) newcomer.seen = false;
  for (const Unexplained& what : unexplained_) {
    const double px_m = what.centroid.z / frame_.camera.fx;
    if (what.pixels < kLeastNewcomer_px || what.pixels * px_m * px_m < kLeastNewcomer_m2) continue;
    Newcomer* known = newcomer_at(what.box);
    if (known == nullptr || known->seen) {  // of two in one place each has to stand its time
      newcomers_.push_back({what.box, 1, 0, true});
      continue;
    }
    known->box = what.box;
    known->seen = true;
    if (is_looked_for_in(what) || is_barren(what) || ++known->frames < kNewcomerFrames) continue;
    if (begin_from_pixels(what)) known->seen = false;
  }
  for (std::size_t i = 0; i < newcomers_.size();) {
    if (newcomers_[i].seen)
      ++i;
    else
      newcomers_.erase(i);
  }
}

}  // namespace st
