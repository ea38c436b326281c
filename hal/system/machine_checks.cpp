#include <fcntl.h>
#include <sched.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "algo/core/simd.hpp"
#include "hal/clock.hpp"
#include "hal/error.hpp"
#include "hal/system/arena.hpp"
#include "hal/system/checks.hpp"
#include "hal/system/realtime.hpp"

namespace st {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

constexpr std::size_t kTryBytes = std::size_t{64} << 20;  // what object mode locks, roughly
constexpr double kMB = 1e6;
constexpr double kRecording_mbps =
    640.0 * 480 * (2 + 3) * 30 / kMB;  // depth and colour of a Kinect, uncompressed

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

Finding from_step(const char* check, const SetupStep& step) {
  return {step.ok ? Level::kOk : Level::kWarn, check, step.line, step.remedy};
}

Finding check_governor(const std::string& root) {
  std::set<std::string> governors;
  std::error_code none;
  for (const fs::directory_entry& cpu : fs::directory_iterator(root + "/sys/devices/system/cpu", none)) {
    std::ifstream in(cpu.path() / "cpufreq/scaling_governor");
    std::string governor;
    if (in >> governor) governors.insert(governor);
  }
  if (governors.empty()) return {Level::kOk, "cpu governor", "not set by this system", ""};
  std::string all;
  for (const std::string& governor : governors) all += (all.empty() ? "" : ", ") + governor;
  if (all == "performance") return {Level::kOk, "cpu governor", all, ""};
  return {Level::kWarn, "cpu governor", all + ": the CPU slows down between frames",
          "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"};
}

Finding check_huge_pages(const std::string& root) {
  std::ifstream in(root + "/sys/kernel/mm/transparent_hugepage/enabled");
  std::string setting;
  std::getline(in, setting);
  if (setting.find("[always]") != std::string::npos || setting.find("[madvise]") != std::string::npos)
    return {Level::kOk, "huge pages", setting, ""};
  return {Level::kWarn, "huge pages", setting.empty() ? "this kernel has none" : setting,
          "echo madvise | sudo tee /sys/kernel/mm/transparent_hugepage/enabled"};
}

Finding check_memory(const std::string& root) {
  std::ifstream in(root + "/proc/meminfo");
  std::string line;
  double mib = 0;
  while (std::getline(in, line)) {
    unsigned long long kib = 0;
    if (std::sscanf(line.c_str(), "MemAvailable: %llu kB", &kib) == 1) mib = static_cast<double>(kib) / 1024;
  }
  const std::string found = rounded(mib) + " MiB available";
  if (mib >= 512) return {Level::kOk, "memory", found, ""};
  return {mib < 192 ? Level::kFail : Level::kWarn, "memory", found,
          "close other programs; object mode needs up to 192 MiB"};
}

Finding check_cores() {
  cpu_set_t allowed;
  const int count = sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 1;
  if (count >= 2) return {Level::kOk, "cpu cores", std::to_string(count), ""};
  return {Level::kWarn, "cpu cores", "one: the loop shares it with USB and decoding",
          "use a PC with two cores or more"};
}

Finding check_simd() {
  const auto names = supported_simd();
  if (names.empty()) return {Level::kFail, "simd", "this CPU lacks SSSE3", "use a PC built after 2008"};
  std::string all;
  for (const char* name : names) all += (all.empty() ? "" : ", ") + std::string(name);
  if (std::strcmp(names[names.size() - 1], "AVX2") == 0 || std::strcmp(names[names.size() - 1], "AVX3") == 0)
    return {Level::kOk, "simd", all, ""};
  return {Level::kWarn, "simd", all + ": frames take two to three times as long as with AVX2",
          "use a PC with AVX2 for scan mode"};
}

Finding try_priority() {
  SetupStep step;
  std::thread([&step] { step = use_realtime_priority(kLoopPriority); }).join();
  return from_step("real-time priority", step);
}

void try_memory(std::vector<Finding>& findings) {
  try {
    const Arena arena(kTryBytes);
    findings.push_back(from_step("memory lock", arena.lock()));
  } catch (const Failure& failure) {
    findings.push_back({Level::kFail, "memory lock", failure.what(), "close other programs"});
  }
}

// Writes and syncs a file that is removed at once; MB/s, or a negative number when it cannot be written.
double write_speed_mbps(const std::string& folder) {
  std::string name = folder + "/.startrack-doctor-XXXXXX";
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) return -1;
  unlink(name.c_str());
  const std::vector<char> block(std::size_t{4} << 20, 'x');
  const std::int64_t begin_ns = system_clock().monotonic_ns();
  bool written = true;
  for (std::size_t done = 0; written && done < kTryBytes; done += block.size())
    written = write(file, block.data(), block.size()) == static_cast<ssize_t>(block.size());
  written = written && fdatasync(file) == 0;
  const double seconds = static_cast<double>(system_clock().monotonic_ns() - begin_ns) * 1e-9;
  close(file);
  return written ? static_cast<double>(kTryBytes) / kMB / seconds : -1;
}

void try_disk(const std::string& folder, std::vector<Finding>& findings) {
  struct statvfs disk {};
  const bool known = statvfs(folder.c_str(), &disk) == 0;
  const double free_mb =
      known ? static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize) / kMB : 0;
  const std::string minutes = rounded(free_mb / kRecording_mbps / 60) + " minutes of recording";
  if (!known || free_mb < 200) {
    findings.push_back({Level::kFail, "disk space", folder + ": " + rounded(free_mb) + " MB free",
                        "make room or work in another folder"});
    return;
  }
  findings.push_back({free_mb < 3000 ? Level::kWarn : Level::kOk, "disk space",
                      folder + ": " + rounded(free_mb) + " MB free, " + minutes,
                      free_mb < 3000 ? "make room before recording" : ""});
  const double mbps = write_speed_mbps(folder);
  if (mbps < 0)
    findings.push_back(
        {Level::kFail, "disk speed", folder + " cannot be written", "work in a folder of your own"});
  else if (mbps < 1.5 * kRecording_mbps)
    findings.push_back({Level::kWarn, "disk speed",
                        rounded(mbps) + " MB/s, a recording needs " + rounded(kRecording_mbps),
                        "record to a faster disk"});
  else
    findings.push_back({Level::kOk, "disk speed", rounded(mbps) + " MB/s", ""});
}

}  // namespace

std::vector<Finding> check_settings(const std::string& root) {
  return {check_cores(), check_simd(), check_governor(root), check_huge_pages(root), check_memory(root)};
}

std::vector<Finding> try_machine(const std::string& folder) {
  std::vector<Finding> findings{try_priority()};
  try_memory(findings);
  try_disk(folder, findings);
  return findings;
}

}  // namespace st
