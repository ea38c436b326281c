#include "tools/evaluate/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"
#include "hal/results/csv_table.hpp"
#include "tools/evaluate/alignment.hpp"
#include "tools/evaluate/measures.hpp"

namespace st {
namespace {

using Json = EvaluationJson;
constexpr double kDegrees = 180 / kPi, kMillimetres = 1e3;
constexpr double kGateM = 0.4;  // track to object, when there are several

struct Track {
  std::string name;
  std::vector<double> t;
  std::vector<Pose> T;
};

Track track_of(const std::string& name, const std::vector<TumPose>& poses, const std::string* only) {
  Track track;
  track.name = name;
  for (const TumPose& pose : poses) {
    if (only != nullptr && pose.track != *only) continue;
    track.t.push_back(pose.t_s);
    track.T.push_back(pose.T);
  }
  return track;
}

Json matrix(const Pose& T) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) rows.push_back({T.R(r, 0), T.R(r, 1), T.R(r, 2), T.t[r]});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

std::vector<bool> live_frames(const Visibility& visibility, const std::vector<double>& t,
                              const std::string& label) {
  std::vector<bool> live(t.size(), true);
  if (visibility.text.empty()) return live;
  const CsvTable table = parse_csv(visibility.text, visibility.name);
  std::string column = label + "_px";
  if (label.empty() || !table.has(column)) {
    const auto found =
        std::ranges::find_if(table.columns, [](std::string_view name) { return name.ends_with("_px"); });
    if (found == table.columns.end() || table.rows() == 0)
      throw Failure(ExitCode::kBadInput, visibility.name + ": has no column NAME_px; is it a visible.csv?");
    column = *found;
  }
  const std::size_t px = table.column(column),
                    share = table.column(column.substr(0, column.size() - 3) + "_frac");
  const std::size_t host = table.column("host_t"), clock = table.column("clk_t");
  // Whichever of the two clocks the truth is in.
  const bool by_host =
      !t.empty() && std::fabs(table.number(0, host) - t[0]) < std::fabs(table.number(0, clock) - t[0]);
  std::vector<double> stamps;
  for (std::size_t r = 0; r < table.rows(); ++r) stamps.push_back(table.number(r, by_host ? host : clock));
  constexpr double kEarlyS = 1e-4, kLeastPixels = 400, kLeastShare = 0.5;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto at =
        static_cast<std::size_t>(std::ranges::lower_bound(stamps, t[i] - kEarlyS) - stamps.begin());
    const std::size_t r = std::min(at, stamps.size() - 1);
    live[i] = table.number(r, px) >= kLeastPixels && table.number(r, share) >= kLeastShare;
  }
  return live;
}

struct Errors {
  std::vector<double> distance, rotation, yaw, tilt;
};

// Errors of estimates whose frames are the truth's already. Yaw is the twist about the floor normal
// (swing-twist).
Errors errors_of(const std::vector<Pose>& estimate, const std::vector<Pose>& truth, const Vec3& normal) {
  Errors e;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    e.distance.push_back(norm(estimate[i].t - truth[i].t));
    const Mat3 E = estimate[i].R * truth[i].R.transposed();
    e.rotation.push_back(rotation_angle(E));
    const Quaternion q = to_quaternion(E);
    e.yaw.push_back(wrap_angle(2 * std::atan2(dot({q.x, q.y, q.z}, normal), q.w)));
    e.tilt.push_back(std::acos(std::clamp(dot(estimate[i].R.col(2), truth[i].R.col(2)), -1.0, 1.0)));
  }
  return e;
}

Json error_block(const std::vector<Pose>& estimate, const std::vector<Pose>& truth, const Pose& B,
                 const Vec3& normal) {
  constexpr double kFarM = 0.1, kFarRad = 10 * kPi / 180;
  std::vector<Pose> moved;
  for (const Pose& T : estimate) moved.push_back(T * B);
  Errors e = errors_of(moved, truth, normal);
  double sum = 0, square = 0, most = 0;
  for (const double yaw : e.yaw) sum += yaw, square += yaw * yaw, most = std::max(most, std::fabs(yaw));
  const double n = static_cast<double>(e.yaw.size());
  const auto over = [](const std::vector<double>& values, double limit) {
    return std::ranges::count_if(values, [limit](double v) { return v > limit; });
  };
  const Json far_m = over(e.distance, kFarM), far_rad = over(e.rotation, kFarRad);
  const Json last = {{"trans_mm", e.distance.back() * kMillimetres}, {"yaw_deg", e.yaw.back() * kDegrees}};
  return {
      {"trans_mm", statistics(std::move(e.distance), kMillimetres)},
      {"rot_deg", statistics(std::move(e.rotation), kDegrees)},
      {"yaw_deg",
       {{"rmse", std::sqrt(square / n) * kDegrees}, {"mean", sum / n * kDegrees}, {"max", most * kDegrees}}},
      {"tilt_deg", statistics(std::move(e.tilt), kDegrees)},
      {"frames_over_100mm", far_m},
      {"frames_over_10deg", far_rad},
      {"final", last}};
}

// The parts of both that were associated, in order.
struct Matched {
  std::vector<double> t;
  std::vector<Pose> estimate, truth;
};

Json score_object(const Track& truth, const Track& estimate, const std::vector<bool>& live) {
  const auto pairs = associate(truth.t, estimate.t);
  std::vector<bool> have(truth.t.size());
  Matched m;
  std::size_t seen = 0, covered = 0, unseen = 0;
  for (const bool l : live) seen += l ? 1 : 0;
  for (const auto& [g, e] : pairs) {
    have[g] = true;
    (live[g] ? covered : unseen) += 1;
    if (!live[g]) continue;
    m.t.push_back(truth.t[g]);
    m.truth.push_back(truth.T[g]);
    m.estimate.push_back(estimate.T[e]);
  }
  Json result = {
      {"gt_frames", truth.t.size()},
      {"gt_frames_visible", seen},
      {"estimates", estimate.t.size()},
      {"matched", pairs.size()},
      {"coverage", static_cast<double>(covered) / static_cast<double>(std::max<std::size_t>(1, seen))},
      {"gaps", gaps(truth.t, have, live)},
      {"estimates_while_invisible", unseen}};
  if (m.t.size() < 3) {
    result["error"] = "fewer than 3 associated frames";
    return result;
  }
  Vec3 normal{};
  for (const Pose& T : m.truth) normal += T.R.col(2);
  normal = normalized(normal);
  const Pose B = solve_offset(m.estimate, m.truth);
  result["B"] = matrix(B);
  result.update(error_block(m.estimate, m.truth, B, normal));
  const auto first = static_cast<std::size_t>(std::ranges::upper_bound(m.t, m.t[0] + 1.0) - m.t.begin());
  if (first >= 3)
    result["first_b"] = error_block(
        m.estimate, m.truth,
        solve_offset(std::span(m.estimate).first(first), std::span(m.truth).first(first)), normal);
  std::vector<Pose> moved;
  for (const Pose& T : m.estimate) moved.push_back(T * B);
  result["rpe_1s"] = relative_error(m.t, moved, m.truth);
  result["gt_path_m"] = way_length(m.truth);
  double turn = 0;
  for (std::size_t i = 1; i < m.truth.size(); ++i)
    turn += rotation_angle(m.truth[i - 1].R.transposed() * m.truth[i].R);
  result["gt_turn_deg"] = turn * kDegrees;
  return result;
}

// Which track is nearest to the object in each frame; -1: none within the gate.
std::vector<int> nearest_tracks(const Track& truth, const std::vector<Track>& tracks,
                                const std::vector<bool>& live) {
  std::vector<int> who(truth.t.size(), -1);
  std::vector<double> nearest(truth.t.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < tracks.size(); ++k)
    for (const auto& [g, e] : associate(truth.t, tracks[k].t)) {
      const double d = norm(tracks[k].T[e].t - truth.T[g].t);
      if (d >= nearest[g]) continue;
      nearest[g] = d;
      who[g] = d <= kGateM && live[g] ? static_cast<int>(k) : -1;
    }
  return who;
}

Json score_among_tracks(const Track& truth, const std::vector<Track>& tracks, const std::vector<bool>& live) {
  const std::vector<int> who = nearest_tracks(truth, tracks, live);
  std::vector<std::size_t> frames(tracks.size());
  std::set<int> used;
  std::size_t seen = 0, any = 0, switches = 0;
  int last = -1;
  for (std::size_t i = 0; i < who.size(); ++i) {
    seen += live[i] ? 1 : 0;
    if (who[i] < 0) continue;
    ++any;
    ++frames[static_cast<std::size_t>(who[i])];
    used.insert(who[i]);
    switches += last >= 0 && last != who[i] ? 1 : 0;
    last = who[i];
  }
  if (any == 0)
    return {{"gt", truth.name},          {"gt_frames", truth.t.size()},
            {"gt_frames_visible", seen}, {"matched", 0},
            {"coverage", 0.0},           {"error", "no track within the gate"}};
  const auto main = static_cast<std::size_t>(std::ranges::max_element(frames) - frames.begin());
  Json result = score_object(truth, tracks[main], live);
  result["gt"] = truth.name;
  result["track"] = tracks[main].name;
  result["tracks"] = tracks.size();
  result["id_switches"] = switches;
  result["coverage_any_track"] =
      static_cast<double>(any) / static_cast<double>(std::max<std::size_t>(1, seen));
  result["tracks_used"] = used.size();
  return result;
}

}  // namespace

std::string evaluate_objects(const std::vector<NamedTrajectory>& truths,
                             const std::vector<NamedTrajectory>& estimates, const Visibility& visibility) {
  std::vector<Track> tracks;
  std::size_t dropped = 0;
  for (const NamedTrajectory& e : estimates) {
    dropped += e.trajectory.dropped_lines;
    std::set<std::string> ids;
    for (const TumPose& pose : e.trajectory.poses) ids.insert(pose.track);
    for (const std::string& id : ids) tracks.push_back(track_of(e.name + "#" + id, e.trajectory.poses, &id));
  }
  Json all = Json::array();
  std::size_t switches = 0;
  for (std::size_t k = 0; k < truths.size(); ++k) {
    const Track truth = track_of(truths[k].name, truths[k].trajectory.poses, nullptr);
    const std::vector<bool> live =
        live_frames(visibility, truth.t, truths.size() > 1 ? std::to_string(k + 1) : "");
    if (tracks.empty()) {
      const auto seen = std::ranges::count(live, true);
      all.push_back({{"gt", truth.name},
                     {"gt_frames", truth.t.size()},
                     {"gt_frames_visible", seen},
                     {"matched", 0},
                     {"coverage", 0.0},
                     {"error", "no estimates"}});
      continue;
    }
    Json result;
    if (tracks.size() == 1 && truths.size() == 1) {
      result = score_object(truth, tracks[0], live);
      result.update({{"gt", truth.name}, {"track", tracks[0].name}, {"tracks", 1}, {"id_switches", 0}});
    } else {
      result = score_among_tracks(truth, tracks, live);
    }
    if (!result.contains("error") || result.contains("gaps")) result["dropped_lines"] = dropped;
    switches += result.value("id_switches", std::size_t{0});
    all.push_back(std::move(result));
  }
  const Json out = all.size() == 1 ? all[0] : Json{{"objects", all}, {"id_switches", switches}};
  return out.dump(1) + "\n";
}

std::string evaluate_camera(const NamedTrajectory& truth_file, const NamedTrajectory& estimate_file) {
  const Track truth = track_of(truth_file.name, truth_file.trajectory.poses, nullptr);
  const Track estimate = track_of(estimate_file.name, estimate_file.trajectory.poses, nullptr);
  const auto pairs = associate(truth.t, estimate.t);
  std::vector<bool> have(truth.t.size());
  Matched m;
  for (const auto& [g, e] : pairs) {
    have[g] = true;
    m.t.push_back(truth.t[g]);
    m.truth.push_back(truth.T[g]);
    m.estimate.push_back(estimate.T[e]);
  }
  Json result = {{"gt", truth.name},
                 {"gt_frames", truth.t.size()},
                 {"estimates", estimate.t.size()},
                 {"matched", pairs.size()},
                 {"dropped_lines", estimate_file.trajectory.dropped_lines},
                 {"coverage", static_cast<double>(pairs.size()) /
                                  static_cast<double>(std::max<std::size_t>(1, truth.t.size()))},
                 {"gaps", gaps(truth.t, have, std::vector<bool>(truth.t.size(), true))}};
  if (pairs.size() < 3) {
    result["error"] = "fewer than 3 associated frames";
    return result.dump(1) + "\n";
  }
  const auto block = [&m](const Pose& X) -> Json {
    std::vector<double> distance, rotation;
    for (std::size_t i = 0; i < m.t.size(); ++i) {
      const Pose C = X * m.estimate[i];
      distance.push_back(norm(C.t - m.truth[i].t));
      rotation.push_back(rotation_angle(C.R.transposed() * m.truth[i].R));
    }
    const Json last = {{"trans_mm", distance.back() * kMillimetres}, {"rot_deg", rotation.back() * kDegrees}};
    return {{"trans_mm", statistics(std::move(distance), kMillimetres)},
            {"rot_deg", statistics(std::move(rotation), kDegrees)},
            {"final", last}};
  };
  const Alignment alignment = align_positions(m.estimate, m.truth);
  result["ate"] = block(alignment.T);
  result["ate"]["alignment"] = matrix(alignment.T);
  result["ate"]["sim3_scale"] = alignment.scale;
  result["first_pose"] = block(m.truth[0] * m.estimate[0].inverse());
  result["rpe_1s"] = relative_error(m.t, m.estimate, m.truth);
  result["gt_path_m"] = way_length(m.truth);
  return result.dump(1) + "\n";
}

}  // namespace st
