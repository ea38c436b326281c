#include "algo/tracking/birth.hpp"

#include <algorithm>
#include <cmath>

namespace st {
namespace {

// Values below which 1 % and 99 % of the points lie, by counting in 256 bins.
void trimmed_range(std::span<const ObservedPoint> points, const Vec3& axis, double& low, double& high) {
  constexpr int kBins = 256;
  low = 1e9;
  high = -1e9;
  for (const ObservedPoint& point : points) {
    const double x = dot(axis, to_double(point.p));
    low = x < low ? x : low;
    high = x > high ? x : high;
  }
  if (!(high > low)) return;
  int bins[kBins]{};
  const double width = (high - low) / kBins;
  for (const ObservedPoint& point : points) {
    int bin = static_cast<int>((dot(axis, to_double(point.p)) - low) / width);
    bin = bin < 0 ? 0 : bin >= kBins ? kBins - 1 : bin;
    ++bins[bin];
  }
  const int trim = static_cast<int>(points.size() / 100);
  int first = 0, last = kBins - 1;
  for (int sum = bins[0]; sum <= trim && first < kBins - 1; sum += bins[first]) ++first;
  for (int sum = bins[kBins - 1]; sum <= trim && last > first; sum += bins[last]) --last;
  high = low + (last + 1) * width;
  low = low + first * width;
}

}  // namespace

Footprint find_footprint(std::span<const ObservedPoint> points, const Support& support) {
  const Mat3& R = support.R_camera_floor;
  double low[3], high[3];
  for (int i = 0; i < 3; ++i) trimmed_range(points, R.col(i), low[i], high[i]);
  Footprint footprint;
  const double floor_level = -support.d;  // up . p on the floor
  footprint.on_floor = support.found && low[2] < floor_level + 0.12;
  const double base = support.found ? floor_level : low[2];
  const Vec3 centre{0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), base};
  footprint.T_camera_object = {R, R * centre};
  footprint.bounds.low = Vec3{low[0], low[1], footprint.on_floor ? base : low[2]} - centre;
  footprint.bounds.high = Vec3{high[0], high[1], high[2]} - centre;
  return footprint;
}

void start_track(Track& track, const Footprint& footprint, const Support& support, double t_s) {
  const Vec3 size = footprint.bounds.size();
  const double extent = std::max(size.x, std::max(size.y, size.z));
  const double box = std::max(kLeastBox_m, kBoxGrowth * extent);
  const float voxel_m = static_cast<float>(box / track.volume.side);
  const float sigma_m = depth_sigma_m(static_cast<float>(footprint.T_camera_object.t.z));
  track.volume.reset(voxel_m, choose_truncation_m(voxel_m, sigma_m), to_float(footprint.bounds.centre()));
  track.phase = Track::Phase::kCandidate;
  track.id = 0;
  track.left_view = false;
  track.bounds = footprint.bounds;
  track.motion.start(footprint.T_camera_object, support.R_camera_floor.transposed(), t_s);
  track.T_camera_object = footprint.T_camera_object;
  track.state = TrackState::kPoor;
  track.T_birth = footprint.T_camera_object;
  track.has_moved = false;
  track.from_background = false;
  track.owned_pixels = track.divided_run = track.cut_balance = track.double_run = track.lost_run = 0;
  track.good_poses = track.poor_run = track.integrated = track.still_run = track.published_gap = 0;
  track.last_good_t_s = t_s;
  track.T_last_good = footprint.T_camera_object;
  track.yaw_unwrapped = 0;
  track.told_full = false;
  track.aligned = {};
  track.agreement = {};
  track.verdict = Verdict::kLost;
  track.yaw_source = YawSource::kNone;
  track.drive.reset();
  track.heading = {};
  track.heading_doubt = false;
  track.sides = SeenSides{};
  track.habit = Habit{};
  track.named_model = track.known_model = -1;
  track.T_model_object = Pose{};
  track.look_ups = 0;
  track.planar = footprint.on_floor;
  track.off_floor_run = track.on_floor_run = 0;
  track.view_pixels = 0;
  track.points_used = 0;
}

}  // namespace st
