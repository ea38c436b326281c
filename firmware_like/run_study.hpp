// What only the whole run can tell: where each object's base is, and how the path was driven. Works on the
// rows of the result files, so that the end of a run and `startrack report` come to the same figures.
#pragma once

#include <span>
#include <vector>

#include "algo/control/base_estimate.hpp"
#include "algo/control/path_compare.hpp"
#include "algo/core/mesh.hpp"
#include "hal/results/object_files.hpp"
#include "hal/results/run_end.hpp"

namespace st {

struct ObjectTrack {
  int id = 0;
  std::vector<ObjectRow> rows;
  std::span<const MeshVertex> vertices;  // the model's, for what the shape says about the base; may be empty
};

struct ObjectStudy {
  int id = 0;
  double path_length_m = 0;
  bool has_base = false;  // moved like a differential-drive robot, or is the one that steers
  BaseEstimate base;
  std::vector<PlanarSample> driven;  // the base on the floor, a sample per row that has a pose
};

struct PathStudy {
  int object = 0;  // whose base drove it; 0: nobody's
  PathComparison comparison;
  std::vector<PlanarSample> driven;  // what was compared
  std::vector<PathError> placed, shaped;
  std::vector<PathSample> on_floor;  // the preset path, laid from the base's first pose
};

struct RunStudy {
  std::vector<ObjectStudy> objects;
  PathStudy path;
};

// Who drove the path, as far as the run knows it.
struct PathDriver {
  int object = 0;   // 0: not known; the base that fits the path's shape best is taken
  double t_s = -1;  // the path begins after that: what was driven before was the start motion
};

// `path` in the frame of its start, may be empty.
RunStudy study_run(std::span<const ObjectTrack> tracks, std::span<const PathSample> path,
                   const PathDriver& driver);

// The part that goes to the result files.
RunAnalysis to_analysis(const RunStudy& study);

}  // namespace st
