// The short table that a run ends with, for people.
#pragma once

#include <string>

namespace st {

// Reads the run's files back, so that what is printed is what was written. `path_file` empty: no path.
void print_run_table(const std::string& run_folder, const std::string& path_file);

}  // namespace st
