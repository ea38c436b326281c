#include "firmware_like/mode.hpp"

#include <cstdio>
#include <optional>

#include "firmware_like/object_loop.hpp"
#include "firmware_like/scan_loop.hpp"
#include "firmware_like/session_end.hpp"
#include "hal/system/stop_signal.hpp"

namespace st {
namespace {

class ObjectRun final : public ModeRun {
 public:
  ObjectRun(const Calibration& calibration, const LoopConfig& config, const KnownObjects& known)
      : config_(config), known_(known), tracker_(calibration, config) {
    if (config.tracker == TrackerKind::kRecognition && known.file.empty())
      throw Failure(ExitCode::kBadInput,
                    "--tracker recognition: needs --models DB, the objects that it shall recognise");
    if (!known.file.empty()) library_.read(store_.emplace(known.file), tracker_.volume_side());
    tracker_.know(library_);
  }
  const char* name() const override { return "object"; }
  BudgetColumn budget() const override { return BudgetColumn::kObject; }
  void plan_memory(MemoryPlan& plan) override {
    tracker_.plan_memory(plan);
    if (!library_.empty()) plan.add("known models", "firmware_like", library_);
  }
  void start() override { tracker_.start(); }
  std::unique_ptr<Loop> make_loop(const LoopParts& parts) override {
    return std::make_unique<ObjectLoop>(parts, config_, tracker_);
  }
  void describe(RunEnd& end) override {
    end.floor_found = tracker_.floor_found();
    end.has_floor_frame = tracker_.has_floor_frame();
    end.T_floor_camera = tracker_.T_floor_camera();
    end.steering_object = tracker_.wheeled_id();
    end.objects = object_ends(tracker_, meshes_);
    if (tracks_by_matches(config_.tracker)) end.matching = matching_of(tracker_.match_counts());
  }
  void keep(RunEnd& end) override {
    if (!store_) return;
    const KeepOptions keep{end.info.source, end.info.version, known_.picture,
                           !tracks_by_matches(config_.tracker)};
    for (const std::string& line : keep_models(tracker_, library_, *store_, keep, end.objects))
      std::fprintf(stderr, "startrack: %s\n", line.c_str());
  }

 private:
  LoopConfig config_;
  KnownObjects known_;
  ObjectTracker tracker_;
  std::optional<ModelStore> store_;
  ModelLibrary library_;
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

std::unique_ptr<ModeRun> make_mode(const Calibration& calibration, const LoopConfig& config,
                                   const KnownObjects& known) {
  if (config.mode == Mode::kScan) return std::make_unique<ScanRun>(calibration, config);
  return std::make_unique<ObjectRun>(calibration, config, known);
}

}  // namespace st
