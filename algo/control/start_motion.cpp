#include "algo/control/start_motion.hpp"

#include <cmath>

#include "algo/control/lag_search.hpp"
#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kPause_s = 0.3;
constexpr double kLongestCommand_s = 0.25;              // then the guard stops the robot
constexpr double kSigma_m = 0.002, kSigma_rad = 0.012;  // of a tracked pose, for weighing the two
// What obeying means. The wheels are as large as believed to within a quarter.
constexpr std::size_t kLeastFrames = 30;
constexpr double kLeastWay_m = 0.03, kLeastTurn_rad = 0.1;  // of the wheels, while it was seen
constexpr double kGain = 0.25, kMostMisfit_m = 0.006, kMostMisfit_rad = 0.06, kLeastExplained = 0.9;
constexpr double kFarthestBase_m = 0.3;

// Speed along one direction of which so much is used up. Beyond the allowance, where a push has brought it,
// it does not drive on, and is not driven back at the speed that the rest would ask for.
double slowed(double speed, double used, double allowance) {
  const double ahead = allowance - used, back = -allowance - used;
  const double most = ahead > 0 ? ahead / kLongestCommand_s : 0;
  const double least = back < 0 ? back / kLongestCommand_s : 0;
  return speed > most ? most : speed < least ? least : speed;
}

struct Spread {
  double low = 1e9, high = -1e9;
  void add(double v) { low = v < low ? v : low, high = v > high ? v : high; }
  double width() const { return high - low; }
};

}  // namespace

Path start_motion() {
  Path path;
  path.limits = {0.1, 0.3, 0.5, 1.0};
  for (const double way_m : {kStartWay_m, -kStartWay_m}) {
    path.add_line(way_m);
    path.add_wait(kPause_s);
  }
  for (const double turn_rad : {kStartTurn_rad, -2 * kStartTurn_rad, kStartTurn_rad}) {
    path.add_turn(turn_rad);
    path.add_wait(kPause_s);
  }
  path.plan();
  return path;
}

WheelSpeeds within_start_allowance(const WheelSpeeds& speeds, double forward_m, double turn_rad,
                                   double wheel_base_m) {
  const double v = 0.5 * (speeds.left_mps + speeds.right_mps),
               w = (speeds.right_mps - speeds.left_mps) / wheel_base_m;
  return wheel_speeds(slowed(v, forward_m, kStartAllowance_m), slowed(w, turn_rad, kStartAllowance_rad),
                      wheel_base_m);
}

// What cannot be placed in time says nothing: it begins anew.
void StartWitness::add(const WheelOdometry& wheels, const SeenObjects& objects) {
  if (!wheels.valid || count_ == kFrames) count_ = 0;
  Frame next;
  if (count_ > 0) {
    const Frame& last = frames_[count_ - 1];
    next = {last.t_s + wheels.dt_s, last.forward_m + wheels.forward_m, last.turn_rad + wheels.turn_rad, {}};
  }
  next.objects = objects;
  frames_[count_++] = next;
}

void StartWitness::wheels_at(double t_s, double& forward_m, double& turn_rad) const {
  std::size_t low = 0, high = count_ - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (frames_[middle].t_s <= t_s ? low : high) = middle;
  }
  const Frame &a = frames_[low], &b = frames_[high];
  const double raw = b.t_s > a.t_s ? (t_s - a.t_s) / (b.t_s - a.t_s) : 0;
  const double share = raw < 0 ? 0 : raw > 1 ? 1 : raw;  // it stood before and stands after
  forward_m = a.forward_m + share * (b.forward_m - a.forward_m);
  turn_rad = a.turn_rad + share * (b.turn_rad - a.turn_rad);
}

std::size_t StartWitness::stretch_of(int id, std::span<Sample> samples, BaseGuess& guess) const {
  constexpr std::size_t kLongestGap = 5;  // frames; a shorter one is bridged
  std::size_t n = 0, last = 0;
  Pose2 before;
  for (std::size_t i = 0; i < count_; ++i)
    for (const SeenObject& object : frames_[i].objects) {
      if (object.id != id || !object.good || !object.has_heading) continue;
      if (n > 0 && i - last > kLongestGap) n = 0;  // the later stretch is the better known one
      Sample sample{frames_[i].t_s, n > 0 ? samples[n - 1].motion : BodyMotion{}};
      if (n > 0) sample.motion.add(before, object.pose);
      samples[n++] = sample;
      before = object.pose;
      last = i;
      guess = object.guess;
    }
  return n;
}

// Regression about the means, since where the sums began is nobody's business.
Obedience StartWitness::fit(int id, std::span<const Sample> samples, const BaseGuess& guess,
                            double lag_s) const {
  Obedience o;
  o.lag_s = lag_s;
  double mean[5]{};
  const double n = static_cast<double>(samples.size());
  for (const Sample& s : samples) {
    double f = 0, turn = 0;
    wheels_at(s.t_s - lag_s, f, turn);
    const double v[5] = {f, turn, s.motion.x_m, s.motion.y_m, s.motion.turn_rad};
    for (int k = 0; k < 5; ++k) mean[k] += v[k] / n;
  }
  double yaw_square = 0;
  Spread way, turned;
  for (const Sample& s : samples) {
    double f = 0, turn = 0;
    wheels_at(s.t_s - lag_s, f, turn);
    way.add(f), turned.add(turn);
    o.motion.add(f - mean[0], turn - mean[1], {s.motion.x_m - mean[2], s.motion.y_m - mean[3], 0}, kSigma_m);
    const double yaw = (s.motion.turn_rad - mean[4]) - (turn - mean[1]);
    yaw_square += yaw * yaw;
  }
  o.base = o.motion.fit(guess);
  const double rest = o.motion.residual(o.base), yaw_rms = std::sqrt(yaw_square / n);
  o.misfit_m = kSigma_m * std::sqrt(rest / n);
  const Pose2& base = o.base.T_object_base;
  const bool obeys = o.base.valid && way.width() >= kLeastWay_m && turned.width() >= kLeastTurn_rad &&
                     std::fabs(o.base.gain - 1) < kGain && o.misfit_m < kMostMisfit_m &&
                     yaw_rms < kMostMisfit_rad && rest < (1 - kLeastExplained) * o.motion.total() &&
                     base.x * base.x + base.y * base.y < kFarthestBase_m * kFarthestBase_m;
  o.id = obeys ? id : 0;
  // What is minimised over the lag.
  o.misfit_m = std::sqrt(o.misfit_m * o.misfit_m +
                         yaw_rms * yaw_rms * (kSigma_m * kSigma_m) / (kSigma_rad * kSigma_rad));
  return o;
}

Obedience StartWitness::judge_one(int id) const {
  std::array<Sample, kFrames> memory;
  BaseGuess guess;
  const std::size_t n = stretch_of(id, memory, guess);
  if (n < kLeastFrames) return {};
  const std::span<const Sample> samples = std::span<const Sample>(memory).first(n);
  return best_lag([&](double lag_s) { return fit(id, samples, guess, lag_s); },
                  [](const Obedience& a, const Obedience& b) { return a.misfit_m < b.misfit_m; });
}

Obedience StartWitness::judge() const {
  Obedience only;
  if (count_ < kLeastFrames) return only;
  int obedient = 0;
  for (const SeenObject& object : frames_[count_ - 1].objects) {
    if (object.id == 0) continue;
    const Obedience o = judge_one(object.id);
    if (o.id == 0) continue;
    only = o;
    ++obedient;
  }
  return obedient == 1 ? only : Obedience{};
}

}  // namespace st
