// A run read back from its folder, whole or interrupted.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hal/results/object_files.hpp"
#include "hal/results/ply_file.hpp"
#include "hal/results/summary_file.hpp"
#include "hal/results/tum_file.hpp"

namespace st {

struct RunRecord {
  struct Object {
    int id = 0;
    std::vector<ObjectRow> rows;
    Mesh mesh;  // empty when there is none
  };
  struct Column {
    std::string name;
    std::vector<double> values;
  };
  struct EventRow {
    double t_s = 0;
    std::string event;
    int object = 0;
    double a = 0, b = 0, c = 0;
  };

  std::string folder;
  std::optional<RunSummary> summary;  // none: the run was interrupted
  std::vector<Object> objects;        // by id
  std::vector<Column> timing;         // as in timing.csv
  std::vector<EventRow> events;
  std::vector<std::array<double, 6>> path;  // path.csv: t,x,y,yaw,v,w; empty without one
  std::vector<TumPose> camera;              // scan mode
  Mesh scene;

  const Column* timing_column(std::string_view name) const;
};

// Throws Failure (kBadInput) when the folder is no run or a file in it is damaged.
RunRecord read_run(const std::string& folder);

}  // namespace st
