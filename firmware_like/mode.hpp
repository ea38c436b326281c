// What a session runs: the part of it that differs between object and scan mode.
#pragma once

#include <memory>

#include "firmware_like/budget.hpp"
#include "firmware_like/loop.hpp"
#include "firmware_like/memory_plan.hpp"
#include "firmware_like/model_keeper.hpp"
#include "hal/results/run_end.hpp"

namespace st {

class ModeRun {
 public:
  virtual ~ModeRun() = default;
  virtual const char* name() const = 0;
  virtual BudgetColumn budget() const = 0;
  virtual void plan_memory(MemoryPlan& plan) = 0;
  virtual void start() = 0;  // once the plan is sealed
  virtual std::unique_ptr<Loop> make_loop(const LoopParts& parts) = 0;
  // After the loop and describe(), before the rest of the run's files: what it learned goes where it is kept.
  // Throws Failure when it cannot be.
  virtual void keep(RunEnd&) {}
  // After the loop: what was tracked, and its models as meshes, unless a second Ctrl-C asked for none. They
  // live as long as this object.
  virtual void describe(RunEnd& end) = 0;
};

// `known`: for object mode; read here. Throws Failure (kBadInput) when its file is no database, and when the
// tracker needs one that is not given.
std::unique_ptr<ModeRun> make_mode(const Calibration& calibration, const LoopConfig& config,
                                   const KnownObjects& known);

}  // namespace st
