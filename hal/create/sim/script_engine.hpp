// Scripts of the Create 1: commands stored in the robot, and waits during which it listens to nobody.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "hal/create/sim/odometer.hpp"

namespace st::sim {

class ScriptEngine {
 public:
  void store(std::span<const std::uint8_t> script) { stored_.assign(script.begin(), script.end()); }
  const std::vector<std::uint8_t>& stored() const { return stored_; }
  // As if the host had sent it all at once; as its own last byte, for ever.
  void play() { queue_.assign(stored_.begin(), stored_.end()); }
  void stop() {
    queue_.clear();
    kind_ = Wait::kNone;
  }

  bool has_byte() const { return !queue_.empty(); }
  std::uint8_t next_byte() {
    const std::uint8_t byte = queue_.front();
    queue_.pop_front();
    return byte;
  }

  // The waits. Distance and angle clear what the robot has summed up, as the specification says.
  void wait_time(double until_s) { kind_ = Wait::kTime, until_s_ = until_s; }
  void wait_distance(int mm, Odometer& odometer);
  void wait_angle(int deg, Odometer& odometer);
  void wait_event(int event) { kind_ = Wait::kEvent, target_ = event; }
  bool waiting() const { return kind_ != Wait::kNone; }
  int awaited_event() const { return kind_ == Wait::kEvent ? target_ : 0; }
  // Ends the wait when it has come true. A distance or angle of the wrong sign never does.
  void look(double time_s, Odometer& odometer, bool event_came);

 private:
  enum class Wait { kNone, kTime, kDistance, kAngle, kEvent };

  std::vector<std::uint8_t> stored_;
  std::deque<std::uint8_t> queue_;
  Wait kind_ = Wait::kNone;
  double until_s_ = 0;
  int target_ = 0;
};

}  // namespace st::sim
