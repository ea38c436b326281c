// The one file that a command writes for its user.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace st {

struct OutFile {
  std::string path;
  bool force = false;  // it may replace a file that stands there

  // Adds --out and --force.
  void add_options(CLI::App& command, const std::string& what, const std::string& type_name);

  // Before any work is done: throws Failure (kBadInput) where something stands at `at` already.
  void check(const std::string& at) const;
};

}  // namespace st
