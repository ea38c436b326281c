// The recordings beside the project, for tests: env STARTRACK_DATA, or ../shared/data beside the sources.
#pragma once

#include <string>
#include <vector>

namespace st::test {

// The folder of a recording in the TUM layout; packed ones (can, hand-wave) are laid out below the build
// folder first, of lab-square only what `members` names (tar wildcards). Empty, with one line "skipped: ...",
// when it is not there.
std::string recording(const std::string& name, const std::vector<std::string>& members = {});

void write_file(const std::string& path, const std::string& content);
void append_file(const std::string& path, const std::string& content);
std::string read_file(const std::string& path);  // empty when it cannot be read

}  // namespace st::test
