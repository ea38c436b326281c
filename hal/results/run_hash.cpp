#include "hal/results/run_hash.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "hal/results/line_file.hpp"
#include "hal/results/run_folder.hpp"

namespace st {

std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash) {
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

std::string deterministic_hash(const std::string& run_folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(run_folder)) {
    const std::string name = entry.path().filename().string();
    const bool counts = name.ends_with(".tum") || name.ends_with(".csv") || name.ends_with(".ply");
    if (counts && name != "timing.csv" && is_result_file(name)) names.push_back(name);
  }
  std::ranges::sort(names);
  std::uint64_t hash = kFnvStart;
  for (const std::string& name : names)
    hash = fnv1a(read_whole_file(std::filesystem::path(run_folder) / name), hash);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace st
