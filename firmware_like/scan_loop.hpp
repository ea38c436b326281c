// The loop of scan mode: the pose of a hand-held camera, and the scene that it has seen.
#pragma once

#include "firmware_like/loop.hpp"
#include "firmware_like/scan_tracker.hpp"

namespace st {

class ScanLoop final : public Loop {
 public:
  ScanLoop(const LoopParts& parts, const LoopConfig& config, ScanTracker& tracker)
      : Loop(parts, config), tracker_(tracker) {}
  LoopEnd run() override;

 private:
  ScanTracker& tracker_;
};

}  // namespace st
