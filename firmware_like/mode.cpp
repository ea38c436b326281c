#include "firmware_like/mode.hpp"

#include "firmware_like/object_loop.hpp"
#include "firmware_like/scan_loop.hpp"
#include "firmware_like/session_end.hpp"
#include "hal/system/stop_signal.hpp"

namespace st {
namespace {

class ObjectRun final : public ModeRun {
 public:
  ObjectRun(const Calibration& calibration, const LoopConfig& config)
      : config_(config), tracker_(calibration, config) {}
  const char* name() const override { return "object"; }
  BudgetColumn budget() const override { return BudgetColumn::kObject; }
  void plan_memory(MemoryPlan& plan) override { tracker_.plan_memory(plan); }
  void start() override { tracker_.start(); }
  std::unique_ptr<Loop> make_loop(const LoopParts& parts) override {
    return std::make_unique<ObjectLoop>(parts, config_, tracker_);
  }
  void describe(RunEnd& end) override {
    end.floor_found = tracker_.floor_found();
    end.has_floor_frame = tracker_.has_floor_frame();
    end.T_floor_camera = tracker_.T_floor_camera();
    end.objects = object_ends(tracker_, meshes_);
  }

 private:
  LoopConfig config_;
  ObjectTracker tracker_;
  ModelMeshes meshes_;
};

class ScanRun final : public ModeRun {
 public:
  ScanRun(const Calibration& calibration, const LoopConfig& config)
      : config_(config), tracker_(calibration, config) {}
  const char* name() const override { return "scan"; }
  BudgetColumn budget() const override { return BudgetColumn::kScan; }
  void plan_memory(MemoryPlan& plan) override { tracker_.plan_memory(plan); }
  void start() override { tracker_.start(); }
  std::unique_ptr<Loop> make_loop(const LoopParts& parts) override {
    return std::make_unique<ScanLoop>(parts, config_, tracker_);
  }
  void describe(RunEnd& end) override {
    end.has_camera = true;
    end.camera = tracker_.count();
    if (!mesh_unwanted()) end.camera.scene = meshes_.extract(tracker_.scene());
  }

 private:
  LoopConfig config_;
  ScanTracker tracker_;
  ModelMeshes meshes_;
};

}  // namespace

std::unique_ptr<ModeRun> make_mode(const Calibration& calibration, const LoopConfig& config) {
  if (config.mode == Mode::kScan) return std::make_unique<ScanRun>(calibration, config);
  return std::make_unique<ObjectRun>(calibration, config);
}

}  // namespace st
