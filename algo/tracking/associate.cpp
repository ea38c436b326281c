#include "algo/tracking/associate.hpp"

#include <cmath>

namespace st {
namespace {

constexpr int kMaxLabels = 64;
constexpr int kLeastOverlap_px = 25;
constexpr int kLeastRest_px = 250;
constexpr int kMatureFrames = 10;    // younger models may grow at any pace
constexpr int kDoubtfulFrames = 10;  // for so long, what a whole segment gained may be something else

struct Claims {
  int overlap[kMaxLabels][kMaxObjects]{};
  bool claimed[kMaxLabels][kMaxObjects]{};
  int claimants[kMaxLabels]{};
};

float gate_of(const Track& track) {
  const float sigma = static_cast<float>(track.motion.position_sigma_m());
  const float gate = 0.04f + 2.0f * sigma;
  return gate < 0.12f ? gate : 0.12f;
}

void count_overlap(const AssociationInput& in, const Track& track, std::size_t k, Claims& claims) {
  const float gate = gate_of(track);
  const Rect box = track.view.maps.roi.clipped(in.labels.width, in.labels.height);
  for (int v = box.v0; v < box.v1; ++v) {
    for (int u = box.u0; u < box.u1; ++u) {
      const std::uint8_t label = in.labels(u, v);
      if (label == 0) continue;
      const float model = track.view.z(u, v);
      if (model > 0 && std::fabs(in.depth_z(u, v) - model) < gate) ++claims.overlap[label][k];
    }
  }
}

Claims claim(const AssociationInput& in, std::span<const Track> tracks) {
  Claims claims;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!tracks[k].active() || tracks[k].view_pixels == 0) continue;
    count_overlap(in, tracks[k], k, claims);
    for (std::size_t i = 0; i < in.segments.size(); ++i) {
      const int overlap = claims.overlap[i + 1][k];
      const bool much_of_segment = overlap * 100 >= in.segments[i].pixels * 15;
      const bool much_of_model = overlap * 100 >= tracks[k].view_pixels * 30;
      if (overlap < kLeastOverlap_px || !(much_of_segment || much_of_model)) continue;
      claims.claimed[i + 1][k] = true;
      ++claims.claimants[i + 1];
    }
  }
  return claims;
}

// Depth of the track's model at the pixel, or near it: the model's edge may lag by a few pixels.
float model_depth_near(const Track& track, int u, int v) {
  constexpr int kReach = 4;
  const int offsets[5][2] = {{0, 0}, {-kReach, 0}, {kReach, 0}, {0, -kReach}, {0, kReach}};
  for (const auto& o : offsets) {
    const float z = track.view.z(u + o[0], v + o[1]);
    if (z > 0) return z;
  }
  return 0;
}

std::uint8_t nearest_model(const Claims& claims, std::span<const Track> tracks, std::uint8_t label, int u,
                           int v, float z) {
  std::uint8_t best = 0;
  float best_gap = 0.03f + 0.004f * z * z;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!claims.claimed[label][k]) continue;
    const float model = model_depth_near(tracks[k], u, v);
    const float gap = std::fabs(z - model);
    if (model > 0 && gap < best_gap) {
      best_gap = gap;
      best = static_cast<std::uint8_t>(k + 1);
    }
  }
  return best;
}

// A mature object shows new surface little by little. One that gains more at once, beyond what its model
// would fill, has something else hanging on it: a hand. But a hand has an arm that goes on to the edge of the
// view; what stays and ends within the view is the object's own.
bool outgrown(const Track& track, const Segment& segment, int image_pixels) {
  const bool mature = track.integrated >= kMatureFrames || track.from_background;
  const int gain = track.owned_pixels + track.owned_pixels / 5;
  const int known = gain > track.view_pixels ? gain : track.view_pixels;
  const bool stays = track.divided_run > kDoubtfulFrames && !segment.touches_border;
  return mature && !stays && segment.pixels > known + image_pixels / 1000;
}

// The one claimant of a segment that it may keep whole; tracks.size() when the segment has to be divided.
std::size_t sole_claimant(const Claims& claims, std::span<const Track> tracks, const Segment& segment,
                          std::size_t label, int image_pixels) {
  if (claims.claimants[label] != 1) return tracks.size();
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!claims.claimed[label][k]) continue;
    return outgrown(tracks[k], segment, image_pixels) ? tracks.size() : k;
  }
  return tracks.size();
}

struct RestStatistics {
  int pixels = 0;
  Rect box = Rect::nothing();
  double x = 0, y = 0, z = 0;

  void add(const Pinhole& camera, int u, int v, float depth) {
    ++pixels;
    box.include(u, v);
    const Vec3f p = camera.ray(static_cast<float>(u), static_cast<float>(v)) * depth;
    x += p.x, y += p.y, z += p.z;
  }
};

}  // namespace

void associate(const AssociationInput& in, std::span<const Track> tracks, ImageView<std::uint8_t> owners,
               std::span<Owned> owned, UnexplainedList& unexplained) {
  const Claims claims = claim(in, tracks);
  for (int i = 0; i < owners.pixels(); ++i) owners.data[i] = 0;
  for (Owned& o : owned) o = {};
  unexplained.clear();
  for (std::size_t i = 0; i < in.segments.size(); ++i) {
    const Segment& segment = in.segments[i];
    const std::uint8_t label = static_cast<std::uint8_t>(i + 1);
    const std::size_t owner = sole_claimant(claims, tracks, segment, label, owners.pixels());
    if (owner == tracks.size())
      for (std::size_t k = 0; k < tracks.size(); ++k)
        owned[k].divided = owned[k].divided || claims.claimed[label][k];
    RestStatistics rest;
    for (int v = segment.box.v0; v < segment.box.v1; ++v) {
      for (int u = segment.box.u0; u < segment.box.u1; ++u) {
        if (in.labels(u, v) != label) continue;
        const float z = in.depth_z(u, v);
        const std::uint8_t k = owner < tracks.size() ? static_cast<std::uint8_t>(owner + 1)
                                                     : nearest_model(claims, tracks, label, u, v, z);
        owners(u, v) = k != 0 ? k : kForeign;
        if (k != 0)
          owned[k - 1u].add(u, v);
        else if (z > 0)
          rest.add(in.camera, u, v, z);
      }
    }
    const bool untouched = claims.claimants[label] == 0;
    if (rest.pixels == 0 || (!untouched && rest.pixels < kLeastRest_px)) continue;
    Unexplained u;
    u.label = label;
    u.box = rest.box;
    u.pixels = rest.pixels;
    u.centroid = {static_cast<float>(rest.x / rest.pixels), static_cast<float>(rest.y / rest.pixels),
                  static_cast<float>(rest.z / rest.pixels)};
    u.touches_border = segment.touches_border;
    u.rest = !untouched;
    unexplained.push_back(u);
  }
}

}  // namespace st
