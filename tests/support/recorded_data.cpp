#include "tests/support/recorded_data.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace st::test {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
  const char* given = std::getenv("STARTRACK_DATA");
  return given != nullptr ? fs::path(given) : fs::path(STARTRACK_SOURCE_DIR) / ".." / "shared" / "data";
}

fs::path scratch_folder() { return fs::path(STARTRACK_BINARY).parent_path() / "test-data"; }

std::string archive_of(const std::string& name) {
  const bool fakenect = name == "can" || name == "hand-wave";
  return (fakenect ? std::string("fakenect-") : std::string()) + name +
         (fakenect ? ".tar.xz" : "-depth.tar.xz");
}

std::string shell_word(const fs::path& path) {
  std::string text = "'";
  return text.append(path.string()).append("'");
}

// Lays the archive out once; a folder that is there was laid out whole, since it is moved there at the end.
bool unpack(const std::string& name, const std::vector<std::string>& members) {
  const fs::path archive = data_folder() / archive_of(name),
                 part = scratch_folder() / ("part-" + std::to_string(getpid()));
  if (!fs::exists(archive)) return false;
  fs::create_directories(part);
  std::string command =
      "tar xJf " + shell_word(archive) + " -C " + shell_word(part) + (members.empty() ? "" : " --wildcards");
  for (const std::string& member : members) command.append(" ").append(shell_word(member));
  const bool done = std::system(command.c_str()) == 0;
  std::error_code error;
  if (done) fs::rename(part / name, scratch_folder() / name, error);
  fs::remove_all(part);
  return done;
}

}  // namespace

std::string recording(const std::string& name, const std::vector<std::string>& members) {
  const fs::path plain = data_folder() / name, unpacked = scratch_folder() / name;
  if (fs::exists(plain)) return plain.string();
  if (fs::exists(unpacked) || unpack(name, members)) return unpacked.string();
  std::printf("skipped: no recording %s; set STARTRACK_DATA to the folder of recordings\n", name.c_str());
  return {};
}

void write_file(const std::string& path, const std::string& content) {
  fs::create_directories(fs::path(path).parent_path());
  std::ofstream(path, std::ios::binary) << content;
}

void append_file(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary | std::ios::app) << content;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace st::test
