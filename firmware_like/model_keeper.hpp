// The end of a run with a database: what was new is stored, what was recognised is updated where the run saw
// more of it, and nothing is stored twice.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "firmware_like/model_library.hpp"
#include "firmware_like/object_tracker.hpp"
#include "hal/results/run_end.hpp"

namespace st {

// Makes a PNG of a mesh; empty: no pictures.
using PictureOf = std::function<std::string(const MeshView&)>;

// The database that a run works with.
struct KnownObjects {
  std::string file;  // empty: none
  PictureOf picture;
};

struct KeepOptions {
  std::string source, program;  // provenance
  PictureOf picture;
  bool may_store = true;  // false: names only
};

// Puts every tracked object's model into the database and the names and ids of all into `objects` (which are
// those of tracker.counts(), in that order). Returns a line for people per change. Throws Failure when the
// database refuses.
std::vector<std::string> keep_models(const ObjectTracker& tracker, const ModelLibrary& library,
                                     ModelStore& store, const KeepOptions& options,
                                     std::vector<ObjectEnd>& objects);

}  // namespace st
