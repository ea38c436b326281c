#include "firmware_like/session.hpp"

#include <unistd.h>

#include <cstdio>
#include <optional>
#include <thread>

#include "algo/core/simd.hpp"
#include "firmware_like/finish_run.hpp"
#include "firmware_like/memory_plan.hpp"
#include "firmware_like/mode.hpp"
#include "firmware_like/path_file.hpp"
#include "firmware_like/progress_line.hpp"
#include "firmware_like/sealed_section.hpp"
#include "firmware_like/session_end.hpp"
#include "hal/create/sim_child.hpp"
#include "hal/results/run_folder.hpp"
#include "hal/system/arena.hpp"
#include "hal/system/key_stop.hpp"
#include "hal/system/prefault.hpp"
#include "hal/system/realtime.hpp"
#include "hal/system/rusage.hpp"
#include "hal/system/stop_signal.hpp"

namespace st {
namespace {

// A refused step is a warning with what to do; one that went well needs no line.
void warn(const SetupStep& step) {
  if (!step.ok) std::fprintf(stderr, "startrack: warning: %s\n", step.text().c_str());
}

void choose_simd(const std::string& name) {
  switch (select_simd(name.empty() ? nullptr : name.c_str())) {
    case SimdChoice::kDone:
      return;
    case SimdChoice::kUnknownName:
      throw Failure(ExitCode::kBadInput,
                    "--simd " + name + ": no such instruction set; there are SSSE3, SSE4, AVX2, AVX3");
    case SimdChoice::kNotOnThisCpu:
      throw Failure(ExitCode::kBadInput,
                    "--simd " + name + ": this CPU does not have it; leave --simd out for its best");
  }
}

std::vector<PathSample> sampled(const Path& path) {
  std::vector<PathSample> samples;
  constexpr double kStep_s = 1.0 / 30.0;
  for (double t = 0; t < path.duration_s(); t += kStep_s) samples.push_back(sample(path, t));
  samples.push_back(sample(path, path.duration_s()));
  return samples;
}

Steering steering_of(const SessionOptions& options) {
  if (options.path_file.empty()) return Steering::kClient;
  return options.closed_loop ? Steering::kClosedLoop : Steering::kOpenLoop;
}

// Runs the loop on a thread of its own: its name, priority and heap guard are the thread's.
LoopEnd run_loop(Loop& loop, bool live, RunEnd& end) {
  LoopEnd why = LoopEnd::kSourceEnded;
  SetupStep priority;
  std::thread compute([&] {
    if (live) priority = use_realtime_priority(kLoopPriority);
    flush_denormals();
    SealedSection sealed;
    why = loop.run();
    sealed.end();
    end.heap_calls_after_seal = sealed.heap_calls();
    end.page_faults_after_seal = static_cast<std::uint64_t>(sealed.usage().faults());
  });
  compute.join();
  warn(priority);
  return why;
}

void finish_recording(Recorder& recorder, SessionResult& result) {
  recorder.close();
  if (recorder.dropped() > 0)
    std::fprintf(stderr,
                 "startrack: warning: %llu frames were not recorded, since the disk did not keep up\n",
                 static_cast<unsigned long long>(recorder.dropped()));
  result.trouble = recorder.failure();
}

}  // namespace

SessionResult run_session(const SessionOptions& options) {
  watch_stop_signals();
  choose_simd(options.simd);
  std::optional<Path> path;
  if (!options.path_file.empty()) path = load_path(options.path_file);
  // The robot first: its guard is a child process, and children are made before the arena is.
  RobotOptions robot_options = options.robot;
  if (!options.record.empty()) {
    make_recording_folder(options.record);
    robot_options.log_path = options.record + "/robot.log";
  }
  std::unique_ptr<DriveBase> robot;
  if (!options.robot.port.empty()) robot = open_robot(robot_options);
  if (robot && !is_simulated(options.robot.port) && !arm_at_terminal()) {
    robot->close();
    return {ExitCode::kInterrupted, {}, "not armed; nothing was driven"};
  }
  std::optional<KeyStop> any_key;
  if (robot) any_key.emplace();
  SourceOptions source_options = options.source;
  if (robot) source_options.robot_state_path = robot->sim_state_path();
  const std::unique_ptr<FrameSource> source = open_source(source_options);
  const SourceInfo& info = source->info();
  std::optional<PoseServer> server;
  if (!options.serve.empty()) server.emplace(options.serve, robot && !path);
  SessionResult result;
  result.folder = prepare_run_folder(options.out, info.short_name, options.force);
  if (!info.calibration_note.empty()) std::fprintf(stderr, "startrack: %s\n", info.calibration_note.c_str());

  const std::unique_ptr<ModeRun> mode = make_mode(info.calibration, options.loop, options.known);
  ReportRing ring;
  BudgetMonitor budget(mode->budget(), info.frame_period_s);
  MemoryPlan plan;
  mode->plan_memory(plan);
  plan.add("reports on their way out", "hal/results", ring);
  Arena arena(plan.bytes());
  plan.seal(arena.bump());
  plan.print(stderr);
  warn(arena.lock());
  mode->start();

  ResultWriter writer(result.folder);
  std::optional<ProgressLine> progress;
  std::vector<TelemetrySink*> sinks{&writer};
  if (isatty(STDERR_FILENO) != 0) sinks.push_back(&progress.emplace(info.expected_frames));
  Telemetry telemetry(ring, sinks);
  telemetry.start();
  std::optional<Recorder> recorder;
  if (!options.record.empty()) recorder.emplace(RecorderOptions{options.record, info.calibration});
  std::optional<RobotDriver> driver;
  if (robot)
    driver.emplace(*robot, steering_of(options), path ? &*path : nullptr,
                   server ? &server->command() : nullptr, options.on_bump);
  const std::unique_ptr<Loop> loop =
      mode->make_loop({*source, telemetry, budget, system_clock(), writer, driver ? &*driver : nullptr,
                       server ? &*server : nullptr, recorder ? &*recorder : nullptr});
  source->start();
  if (server) {
    std::printf("serve: port %d\n", server->port());
    std::fflush(stdout);
    server->start();
  }

  RunEnd end;
  const LoopEnd why = run_loop(*loop, info.live, end);
  if (robot) robot->close();
  source->stop();
  if (server) server->stop();
  if (recorder) finish_recording(*recorder, result);
  telemetry.stop();
  progress.reset();

  end.info = {STARTRACK_VERSION, info.name,         mode->name(), options.tracker_name,
              simd_name(),       options.path_file, info.live};
  end.frames = loop->frames();
  end.ending = ending_of(why);
  end.signal = stop_signal();
  end.last_t_s = loop->last_t_s();
  end.planned_bytes = plan.bytes();
  end.deadline_misses = budget.counts().deadline_misses;
  mode->describe(end);
  std::optional<ExitCode> not_kept;  // the run's own files come all the same
  try {
    mode->keep(end);
  } catch (const Failure& failure) {
    not_kept = failure.code();
    result.trouble = failure.what();
  }
  if (driver) name_steering_object(*driver, end);
  end.peak_rss_bytes = peak_rss_bytes();
  finish_run(writer, end, path ? sampled(*path) : std::vector<PathSample>{});
  // How the run ended comes before what its end cost.
  result.code = exit_code_of(end);
  const bool ran_through = result.code == ExitCode::kDone || result.code == ExitCode::kTrackFailed;
  if (not_kept && ran_through) result.code = *not_kept;
  const std::string more = result.trouble.empty() ? "" : "; " + result.trouble;
  if (why == LoopEnd::kSourceFault) result.trouble = info.name + ": " + source->fault() + more;
  if (why == LoopEnd::kRobotFault)
    result.trouble = "robot " + options.robot.port + ": " + name_of(driver->fault()) + ": " +
                     rule_of(driver->fault()).what_to_do + more;
  return result;
}

}  // namespace st
