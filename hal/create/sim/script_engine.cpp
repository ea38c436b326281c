#include "hal/create/sim/script_engine.hpp"

namespace st::sim {
namespace {

bool reached(double now, int target) { return target >= 0 ? now >= target : now <= target; }

}  // namespace

void ScriptEngine::wait_distance(int mm, Odometer& odometer) {
  odometer.clear_distance();
  kind_ = Wait::kDistance;
  target_ = mm;
}

void ScriptEngine::wait_angle(int deg, Odometer& odometer) {
  odometer.clear_angle();
  kind_ = Wait::kAngle;
  target_ = deg;
}

void ScriptEngine::look(double time_s, Odometer& odometer, bool event_came) {
  const bool over = (kind_ == Wait::kTime && time_s >= until_s_) ||
                    (kind_ == Wait::kDistance && reached(odometer.distance_mm(), target_)) ||
                    (kind_ == Wait::kAngle && reached(odometer.angle_deg(), target_)) ||
                    (kind_ == Wait::kEvent && event_came);
  if (!over) return;
  if (kind_ == Wait::kDistance) odometer.clear_distance();
  if (kind_ == Wait::kAngle) odometer.clear_angle();
  kind_ = Wait::kNone;
}

}  // namespace st::sim
