#include "tools/startrack/out_file.hpp"

#include <filesystem>

#include "hal/error.hpp"

namespace st {

void OutFile::add_options(CLI::App& command, const std::string& what, const std::string& type_name) {
  command.add_option("--out", path, what)->type_name(type_name);
  command.add_flag("--force", force, "replace a file that stands there");
}

void OutFile::check(const std::string& at) const {
  std::error_code error;
  if (force || !std::filesystem::exists(at, error)) return;
  throw Failure(ExitCode::kBadInput,
                at + ": is there already; choose another --out, or --force to replace it");
}

}  // namespace st
