#include "hal/results/run_folder.hpp"

#include <unistd.h>

#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "hal/error.hpp"
#include "hal/results/line_file.hpp"

namespace st {
namespace fs = std::filesystem;
namespace {

Failure refused(const std::string& folder, const std::string& why) {
  return Failure(ExitCode::kBadInput, folder + ": " + why);
}

bool holds_a_recording(const fs::path& folder) {
  return fs::exists(folder / "INDEX.txt") || fs::exists(folder / "depth.txt");
}

void delete_results(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && !entry.is_symlink()) continue;
    if (is_result_file(entry.path().filename().string())) fs::remove(entry.path());
  }
}

// Creates a fresh folder below runs/; another process may take the same second, so the folder itself is the
// claim.
std::string claim_default(std::string_view source) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  const std::string name = default_run_name(local, source);
  fs::create_directories(fs::path(name).parent_path());
  for (int i = 1; i < 1000; ++i) {
    std::string candidate = i == 1 ? name : name + "-" + std::to_string(i);
    if (fs::create_directory(candidate)) return candidate;
  }
  throw refused(name, "a thousand runs have this name; give another with --out");
}

void prepare_given(const std::string& out, bool force) {
  if (fs::exists(out) && !fs::is_directory(out))
    throw refused(out, "is not a folder; give another with --out");
  fs::create_directories(out);
  if (fs::is_empty(out)) return;
  if (holds_a_recording(out)) throw refused(out, "holds a recording; give another folder with --out");
  if (!force)
    throw refused(out, "is not empty; give another folder with --out, or --force to replace the run in it");
  delete_results(out);
}

}  // namespace

int number_in_name(std::string_view name, std::string_view prefix, std::string_view suffix) {
  if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) || !name.ends_with(suffix))
    return 0;
  name.remove_prefix(prefix.size());
  name.remove_suffix(suffix.size());
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool whole = error == std::errc{} && end == name.data() + name.size();
  return whole && number > 0 && name.front() != '0' ? number : 0;
}

bool is_result_file(std::string_view name) {
  static constexpr std::array kPlain{"camera.tum", "scene.ply",   "path.csv",    "timing.csv",
                                     "events.csv", "report.html", "summary.json"};
  static constexpr std::array<std::array<const char*, 2>, 5> kNumbered{{{"object-", ".tum"},
                                                                        {"object-", ".csv"},
                                                                        {"object-", "-covariance.csv"},
                                                                        {"object-", ".ply"},
                                                                        {"base-", ".csv"}}};
  const std::string part = partial_name("");
  if (name.ends_with(part)) name.remove_suffix(part.size());
  for (const char* plain : kPlain)
    if (name == plain) return true;
  for (const auto& [prefix, suffix] : kNumbered)
    if (number_in_name(name, prefix, suffix) > 0) return true;
  return false;
}

std::string default_run_name(const std::tm& local_time, std::string_view source) {
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &local_time);
  std::string name = std::string("runs/") + stamp + "-";
  for (const char c : source) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    name += plain ? c : '-';
  }
  return name;
}

std::string prepare_run_folder(const std::string& out, std::string_view source, bool force) {
  try {
    std::string folder = out;
    if (out.empty())
      folder = claim_default(source);
    else
      prepare_given(out, force);
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
      throw refused(folder, std::string("cannot write here (") + std::strerror(errno) +
                                "); choose another folder with --out");
    return folder;
  } catch (const fs::filesystem_error& error) {
    throw refused(out.empty() ? "runs" : out,
                  "cannot be used (" + error.code().message() + "); choose another folder with --out");
  }
}

}  // namespace st
