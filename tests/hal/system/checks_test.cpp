// The doctor before machines that are laid out in a folder.
#include "hal/system/checks.hpp"

#include <CppUTest/TestHarness.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temp_folder.hpp"

using namespace st;

namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

struct Machine {
  TempFolder folder;
  const std::string& root = folder.path();

  void file(const std::string& path, const std::string& text) const {
    fs::create_directories(fs::path(root + path).parent_path());
    std::ofstream(root + path) << text << '\n';
  }
  void usb(const std::string& name, const std::string& product, const std::string& speed) const {
    const std::string device = "/sys/bus/usb/devices/" + name;
    file(device + "/idVendor", "045e");
    file(device + "/idProduct", product);
    file(device + "/speed", speed);
    file(device + "/busnum", "2");
    file(device + "/devnum", "17");
  }
};

const Finding* find(const std::vector<Finding>& findings, const char* check) {
  for (const Finding& finding : findings)
    if (finding.check == check) return &finding;
  return nullptr;
}

bool is(const std::vector<Finding>& findings, const char* check, Level level) {
  const Finding* finding = find(findings, check);
  if (finding == nullptr || finding->level != level) return false;
  return (level == Level::kOk) == finding->remedy.empty();  // what is not well always comes with a remedy
}

bool remedy_says(const std::vector<Finding>& findings, const char* check, const char* words) {
  const Finding* finding = find(findings, check);
  return finding != nullptr && finding->remedy.find(words) != std::string::npos;
}

}  // namespace

TEST_GROUP(Checks) { Machine machine; };

TEST(Checks, AnEmptyMachineHasNoKinectAndNoRobotAndThatIsNoFailure) {
  const auto findings = check_devices(machine.root);
  CHECK(is(findings, "kinect", Level::kWarn));
  CHECK(is(findings, "udev rule", Level::kWarn));
  CHECK(is(findings, "gspca_kinect", Level::kOk));
  CHECK(is(findings, "serial port", Level::kWarn));
}

TEST(Checks, AKinectThatMayBeOpenedIsWell) {
  machine.usb("2-1", "02ae", "480");
  machine.file("/dev/bus/usb/002/017", "");
  machine.file("/etc/udev/rules.d/60-startrack.rules", "");
  const auto findings = check_devices(machine.root);
  CHECK(is(findings, "kinect", Level::kOk));
  CHECK(is(findings, "kinect speed", Level::kOk));
  CHECK(is(findings, "kinect permission", Level::kOk));
  CHECK(is(findings, "udev rule", Level::kOk));
}

TEST(Checks, AKinectForWindowsIsKnown) {
  machine.usb("2-1", "02bf", "480");
  machine.file("/dev/bus/usb/002/017", "");
  CHECK(is(check_devices(machine.root), "kinect", Level::kOk));
}

TEST(Checks, AKinectWithoutPowerShowsNoCamera) {
  machine.usb("2-1", "02b0", "12");
  const auto findings = check_devices(machine.root);
  CHECK(is(findings, "kinect", Level::kFail));
  CHECK(remedy_says(findings, "kinect", "power supply"));
}

TEST(Checks, ADeviceThatMayNotBeOpenedNamesTheRule) {
  machine.usb("2-1", "02ae", "480");  // and no node below /dev, which may not be opened by root either
  const auto findings = check_devices(machine.root);
  CHECK(is(findings, "kinect permission", Level::kFail));
  CHECK(remedy_says(findings, "kinect permission", "60-startrack.rules"));
}

TEST(Checks, AKinectOnASlowPortFails) {
  machine.usb("2-1", "02ae", "12");
  CHECK(is(check_devices(machine.root), "kinect speed", Level::kFail));
}

TEST(Checks, OtherDevicesOfTheSameMakerAreNoKinect) {
  machine.usb("2-1", "00cb", "480");
  CHECK(is(check_devices(machine.root), "kinect", Level::kWarn));
}

TEST(Checks, TheKernelsWebcamDriverIsFound) {
  machine.file("/sys/module/gspca_kinect/refcnt", "0");
  const auto findings = check_devices(machine.root);
  CHECK(is(findings, "gspca_kinect", Level::kWarn));
  CHECK(remedy_says(findings, "gspca_kinect", "blacklist"));
}

TEST(Checks, ARobotPortAndItsLatencyAreFound) {
  machine.file("/dev/ttyUSB3", "");
  machine.file("/sys/bus/usb-serial/devices/ttyUSB3/latency_timer", "16");
  auto findings = check_devices(machine.root);
  CHECK(is(findings, "serial port", Level::kOk));
  CHECK(is(findings, "serial latency", Level::kWarn));
  machine.file("/sys/bus/usb-serial/devices/ttyUSB3/latency_timer", "1");
  findings = check_devices(machine.root);
  CHECK(find(findings, "serial latency") == nullptr);
}

TEST(Checks, APortThatMayNotBeOpenedNamesTheGroup) {
  machine.file("/dev/x", "");
  fs::create_symlink("nowhere", machine.root + "/dev/ttyUSB0");
  const auto findings = check_devices(machine.root);
  CHECK(is(findings, "serial port", Level::kFail));
  CHECK(remedy_says(findings, "serial port", "dialout"));
}

TEST(Checks, ACableThatBrlttyTookIsSuspected) {
  machine.file("/usr/bin/brltty", "");
  CHECK(remedy_says(check_devices(machine.root), "serial port", "brltty"));
}

TEST(Checks, SettingsThatSlowTheLoopAreFound) {
  machine.file("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  machine.file("/sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave");
  machine.file("/sys/kernel/mm/transparent_hugepage/enabled", "always madvise [never]");
  machine.file("/proc/meminfo", "MemTotal: 900000 kB\nMemAvailable:   300000 kB");
  auto findings = check_settings(machine.root);
  CHECK(is(findings, "cpu governor", Level::kWarn));
  CHECK(is(findings, "huge pages", Level::kWarn));
  CHECK(is(findings, "memory", Level::kWarn));
  machine.file("/sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance");
  machine.file("/sys/kernel/mm/transparent_hugepage/enabled", "always [madvise] never");
  machine.file("/proc/meminfo", "MemTotal: 900000 kB\nMemAvailable:   100000 kB");
  findings = check_settings(machine.root);
  CHECK(is(findings, "cpu governor", Level::kOk));
  CHECK(is(findings, "huge pages", Level::kOk));
  CHECK(is(findings, "memory", Level::kFail));
}

TEST(Checks, TryingLeavesNoFileBehind) {
  const auto findings = try_machine(machine.root);
  CHECK(find(findings, "real-time priority") != nullptr);
  CHECK(find(findings, "memory lock") != nullptr);
  CHECK(find(findings, "disk speed") != nullptr || is(findings, "disk space", Level::kFail));
  CHECK(fs::is_empty(machine.root));
}

TEST(Checks, AFolderThatIsNotThereFails) {
  CHECK(is(try_machine(machine.root + "/none"), "disk space", Level::kFail));
}
