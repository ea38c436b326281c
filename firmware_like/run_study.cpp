#include "firmware_like/run_study.hpp"

#include <cmath>
#include <utility>

#include "algo/control/footprint.hpp"

namespace st {
namespace {

// On the floor and upright, that is, not in somebody's hands.
bool on_floor(const ObjectRow& row) {
  constexpr double kLiftedM = 0.08, kTiltedRad = 0.26;
  return row.has_pose && std::fabs(row.z_m) < kLiftedM && std::fabs(row.roll_rad) < kTiltedRad &&
         std::fabs(row.pitch_rad) < kTiltedRad;
}

PlanarSample planar(const ObjectRow& row) { return {row.t_s, row.x_m, row.y_m, row.yaw_rad}; }

// The noise of thousands of poses would add up to metres: only steps that are clear of it count.
double path_length(std::span<const ObjectRow> rows) {
  constexpr double kStepM = 0.02;
  double length = 0;
  const ObjectRow* last = nullptr;
  for (const ObjectRow& row : rows) {
    if (!row.has_pose) continue;
    const double step = last == nullptr ? 0
                                        : std::sqrt((row.x_m - last->x_m) * (row.x_m - last->x_m) +
                                                    (row.y_m - last->y_m) * (row.y_m - last->y_m));
    if (last != nullptr && step < kStepM) continue;
    length += step;
    last = &row;
  }
  return length;
}

ObjectStudy study_object(const ObjectTrack& track, bool steers, std::span<BaseWindow> windows) {
  ObjectStudy study;
  study.id = track.id;
  study.path_length_m = path_length(track.rows);
  std::vector<PlanarSample> seen;
  for (const ObjectRow& row : track.rows)
    if (row.state == TrackState::kGood && row.has_yaw && on_floor(row)) seen.push_back(planar(row));
  study.base = estimate_base(seen, footprint_prior(track.vertices), windows);
  study.has_base = study.base.differential_drive || (steers && study.base.observed);
  if (!study.has_base) return study;
  const Pose2 T_object_base{study.base.x_m, study.base.y_m, study.base.yaw_rad};
  for (const ObjectRow& row : track.rows) {
    if (!row.has_pose) continue;
    const Pose2 base = compose({row.x_m, row.y_m, row.yaw_rad}, T_object_base);
    study.driven.push_back({row.t_s, base.x, base.y, base.yaw});
  }
  return study;
}

PathStudy study_path(const ObjectStudy& object, const ObjectTrack& track, std::span<const PathSample> path,
                     double begin_t_s) {
  PathStudy study;
  study.object = object.id;
  std::size_t i = 0;
  for (const ObjectRow& row : track.rows)
    if (row.has_pose) {
      if (on_floor(row) && row.t_s >= begin_t_s) study.driven.push_back(object.driven[i]);
      ++i;
    }
  study.placed.resize(study.driven.size());
  study.shaped.resize(study.driven.size());
  std::vector<Point2> scratch(study.driven.size() + 1);
  study.comparison = compare_path(path, study.driven, study.placed, study.shaped, scratch);
  study.placed.resize(study.comparison.count);
  study.shaped.resize(study.comparison.count);
  const Pose2& T = study.comparison.as_placed.T_floor_path;
  const double start_t_s = study.driven.empty() ? 0 : study.driven.front().t_s - path.front().t_s;
  for (const PathSample& s : path) {
    const Pose2 p = compose(T, {s.x_m, s.y_m, s.yaw_rad});
    study.on_floor.push_back({start_t_s + s.t_s, p.x, p.y, p.yaw, s.v_mps, s.w_rps});
  }
  return study;
}

}  // namespace

RunStudy study_run(std::span<const ObjectTrack> tracks, std::span<const PathSample> path,
                   const PathDriver& driver) {
  RunStudy study;
  std::vector<BaseWindow> windows(kBaseWindows);
  for (const ObjectTrack& track : tracks) {
    const bool steers = track.id == driver.object;
    study.objects.push_back(study_object(track, steers, windows));
    const ObjectStudy& object = study.objects.back();
    if (path.empty() || !object.has_base || (driver.object != 0 && !steers)) continue;
    PathStudy candidate = study_path(object, track, path, driver.t_s);
    const bool better =
        study.path.object == 0 || candidate.comparison.shape.rmse_m < study.path.comparison.shape.rmse_m;
    if (candidate.comparison.valid && better) study.path = std::move(candidate);
  }
  return study;
}

RunAnalysis to_analysis(const RunStudy& study) {
  RunAnalysis analysis;
  for (const ObjectStudy& object : study.objects) {
    ObjectAnalysis out{object.id, object.path_length_m, object.has_base, {}};
    const BaseEstimate& base = object.base;
    out.base = {base.x_m, base.y_m, base.yaw_rad, base.sigma_m, base.sigma_rad, {}};
    for (const PlanarSample& s : object.driven) out.base.rows.push_back({s.t_s, s.x_m, s.y_m, s.yaw_rad});
    analysis.objects.push_back(std::move(out));
  }
  analysis.has_path = study.path.object != 0;
  if (!analysis.has_path) return analysis;
  const PathComparison& c = study.path.comparison;
  analysis.path = {
      c.as_placed.rmse_m,  c.shape.rmse_m, c.as_placed.max_m,        c.as_placed.heading_rmse_rad,
      c.as_placed.in_band, c.is_circle,    c.driven_circle.radius_m, {}};
  for (const PathSample& s : study.path.on_floor)
    analysis.path.rows.push_back({s.t_s, s.x_m, s.y_m, s.yaw_rad, s.v_mps, s.w_rps});
  return analysis;
}

}  // namespace st
