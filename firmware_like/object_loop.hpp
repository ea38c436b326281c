// The loop of object mode: poses of what moves before a camera that stands, and a wheel command while a path
// is driven.
#pragma once

#include "firmware_like/loop.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {

class ObjectLoop final : public Loop {
 public:
  ObjectLoop(const LoopParts& parts, const LoopConfig& config, ObjectTracker& tracker)
      : Loop(parts, config), tracker_(tracker) {}
  LoopEnd run() override;

 private:
  void drive();
  DriverView driver_view() const;

  ObjectTracker& tracker_;
};

}  // namespace st
