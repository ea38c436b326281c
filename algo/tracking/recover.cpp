#include "algo/tracking/recover.hpp"

#include <cmath>
#include <utility>

#include "algo/core/scalar_math.hpp"
#include "algo/depth/edge_step.hpp"
#include "algo/tracking/observe.hpp"

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

HiddenSide hidden_side(ImageView<const float> depth_z, ImageView<const std::uint8_t> owners,
                       std::uint8_t owner, const Rect& box, const Rect& view) {
  const int beyond = depth_z.width / 100 + 1;
  int rows = 0, left = 0, right = 0;  // rows that go on behind something nearer, or out of view
  const Rect in = box.clipped(depth_z.width, depth_z.height);
  for (int v = in.v0; v < in.v1; ++v) {
    int first = -1, last = -1;
    for (int u = in.u0; u < in.u1; ++u)
      if (owners(u, v) == owner) first = first < 0 ? u : first, last = u;
    if (first < 0) continue;
    ++rows;
    const auto hides = [&](int u, int edge) {
      if (u <= view.u0 || u >= view.u1 - 1) return true;
      const float z = depth_z(u, v), own = depth_z(edge, v);
      return z > 0 && own > 0 && z < own - edge_step_m(own);
    };
    left += hides(first - beyond, first) ? 1 : 0;
    right += hides(last + beyond, last) ? 1 : 0;
  }
  if (2 * left > rows && left > right) return HiddenSide::kLeft;
  if (2 * right > rows && right > left) return HiddenSide::kRight;
  return HiddenSide::kNone;
}

Pose hypothesis(const Track& track, const Footprint& footprint, const Support& support, double yaw_rad,
                HiddenSide hidden) {
  const Mat3& R = support.R_camera_floor;
  Pose T;
  T.R = orthonormalized(R * rotation_z(yaw_rad));
  // The middle of the model's footprint goes where the candidate's is; its foot to the candidate's foot.
  const Vec3 model{track.bounds.centre().x, track.bounds.centre().y,
                   footprint.on_floor ? 0.0 : track.bounds.low.z};
  Vec3 seen{footprint.bounds.centre().x, footprint.bounds.centre().y,
            footprint.on_floor ? 0.0 : footprint.bounds.low.z};
  // The floor's y axis points to the left of the image.
  const double half = 0.25 * (track.bounds.size().x + track.bounds.size().y);
  if (footprint.bounds.size().y < 1.8 * half) {
    if (hidden == HiddenSide::kLeft) seen.y = footprint.bounds.low.y + half;
    if (hidden == HiddenSide::kRight) seen.y = footprint.bounds.high.y - half;
  }
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
      result.color.used > kLeastColored ? 1.0 / (1.0 + result.color.sigma * result.color.sigma / 200.0) : 0.5;
  return a.same * a.explained * (0.5 + 0.5 * color);
}

bool is_found(const AlignResult& result, const Agreement& a, const Habit& habit) {
  constexpr float kMostLookedThrough = 0.15f;
  return judge(result, a) == Verdict::kGood && a.explained >= habit.least_explained() &&
         a.through <= kMostLookedThrough * (a.same + a.through) && !habit.broken_by_color(result);
}

}  // namespace st
