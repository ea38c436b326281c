#include "algo/tracking/recover.hpp"

#include <cmath>
#include <utility>

#include "algo/core/scalar_math.hpp"

namespace st {

void Search::start(std::size_t lost_track, const Unexplained& candidate, Where there) {
  *this = Search{};
  running = true;
  where = there;
  track = lost_track;
  box = candidate.box;
  centroid = candidate.centroid;
}

void Search::note(double score, const Pose& T_anchor_object) {
  Found fresh{score, T_anchor_object};
  for (Found& kept : best)
    if (fresh.score > kept.score) std::swap(fresh, kept);
}

const Search::Found& Search::best_of_all() const {
  const Found* most = best;
  for (const Found& found : best)
    if (found.score > most->score) most = &found;
  return *most;
}

bool size_fits(const Bounds& model, const Bounds& candidate, bool touches_border) {
  const Vec3 m = model.size(), c = candidate.size();
  const double model_width = std::sqrt(m.x * m.x + m.y * m.y),
               candidate_width = std::sqrt(c.x * c.x + c.y * c.y);
  const double least = touches_border ? 0.2 : 0.5;
  return candidate_width > least * model_width && candidate_width < 1.4 * model_width + 0.05 &&
         c.z > 0.4 * m.z - 0.03 && c.z < 1.4 * m.z + 0.05;
}

Pose hypothesis(const Track& track, const Footprint& footprint, const Support& support, double yaw_rad) {
  const Mat3& R = support.R_camera_floor;
  Pose T;
  T.R = orthonormalized(R * rotation_z(yaw_rad));
  // The middle of the model's footprint goes where the candidate's is; its foot to the candidate's foot.
  const Vec3 model{track.bounds.centre().x, track.bounds.centre().y,
                   footprint.on_floor ? 0.0 : track.bounds.low.z};
  const Vec3 seen{footprint.bounds.centre().x, footprint.bounds.centre().y,
                  footprint.on_floor ? 0.0 : footprint.bounds.low.z};
  T.t = footprint.T_camera_object * seen - T.R * model;
  return T;
}

Pose turned_in_place(const Track& track, const Support& support, double yaw_rad) {
  const Vec3 centre = track.bounds.centre();
  Pose T;
  T.R = orthonormalized(rotation_from_vector(support.up * yaw_rad) * track.T_last_good.R);
  T.t = track.T_last_good * centre - T.R * centre;
  return T;
}

double fit_score(const AlignResult& result, const Agreement& a) {
  if (!result.solved) return 0;
  const double color =
      result.color.used > 30 ? 1.0 / (1.0 + result.color.sigma * result.color.sigma / 200.0) : 0.5;
  return a.same * a.explained * (0.5 + 0.5 * color);
}

bool is_found(const AlignResult& result, const Agreement& a, const Habit& habit) {
  constexpr float kExplained = 0.75f, kMostLookedThrough = 0.15f;
  return judge(result, a) == Verdict::kGood && a.explained >= kExplained &&
         a.through <= kMostLookedThrough * (a.same + a.through) && !habit.broken_by_color(result);
}

}  // namespace st
