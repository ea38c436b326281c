// Finds the recordings that are tested with where they are there (they are not part of the project).
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace st {

// The path of a file below STARTRACK_DATA, or below data/ beside the project. Empty, with a line that says
// so, without it.
inline std::string recording_file(const std::string& name) {
  const char* given = std::getenv("STARTRACK_DATA");
  const std::string folder = given != nullptr ? given : STARTRACK_SOURCE_DIR "/../shared/data";
  const std::string path = folder + "/" + name;
  if (std::filesystem::exists(path)) return path;
  std::printf("skipped: %s is not there\n", path.c_str());
  return {};
}

}  // namespace st
