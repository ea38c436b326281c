// A run from the command line to its result files: opens what is asked for, plans and seals the memory, runs
// the loop on its own thread, and writes what it leaves behind.
#pragma once

#include <string>

#include "firmware_like/config.hpp"
#include "firmware_like/model_keeper.hpp"
#include "hal/create/safety_rules.hpp"
#include "hal/error.hpp"
#include "hal/source/frame_source.hpp"

namespace st {

struct SessionOptions {
  SourceOptions source;
  RobotOptions robot;  // port empty: no robot
  Reaction on_bump = Reaction::kEnd;
  std::string path_file;  // empty: no path
  bool closed_loop = false;
  std::string serve;  // [HOST:]PORT for clients; empty: none
  LoopConfig loop;
  std::string tracker_name = "star";
  std::string record;  // folder for a recording of what the run saw; empty: none
  KnownObjects known;  // object mode
  std::string out;     // run folder; empty: runs/DATE-TIME-SOURCE
  bool force = false;
  std::string simd;  // empty: the best that this CPU has
};

struct SessionResult {
  ExitCode code = ExitCode::kDone;
  std::string folder;
  std::string trouble;  // one line for the user when a device or the robot failed; else empty
};

// Throws Failure for what keeps the run from starting, and for a disk that is full at the end.
SessionResult run_session(const SessionOptions& options);

}  // namespace st
