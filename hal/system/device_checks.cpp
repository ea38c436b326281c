#include <grp.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "hal/system/checks.hpp"

namespace st {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

constexpr const char* kInstallRule =
    "sudo cp packaging/60-startrack.rules /etc/udev/rules.d/ && sudo udevadm control --reload && sudo "
    "udevadm trigger, "
    "then unplug the device and plug it in again";
constexpr const char* kJoinDialout = "sudo usermod -aG dialout $USER, then log in again";

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

struct UsbDevice {
  std::string product, speed_mbps;
  fs::path node;  // below /dev/bus/usb
};

bool is_camera(const UsbDevice& device) { return device.product == "02ae" || device.product == "02bf"; }
bool is_kinect_part(const std::string& product) {
  for (const char* known : {"02ae", "02b0", "02ad", "02bf", "02be", "02c3", "02bb", "02c2"})
    if (product == known) return true;
  return false;
}

std::vector<UsbDevice> kinect_parts(const std::string& root) {
  std::vector<UsbDevice> parts;
  for (const fs::path& entry : entries_of(root + "/sys/bus/usb/devices")) {
    const std::string product = first_line(entry / "idProduct");
    if (first_line(entry / "idVendor") != "045e" || !is_kinect_part(product)) continue;
    char node[32];
    std::snprintf(node, sizeof node, "%03d/%03d", std::atoi(first_line(entry / "busnum").c_str()),
                  std::atoi(first_line(entry / "devnum").c_str()));
    parts.push_back({product, first_line(entry / "speed"), fs::path(root + "/dev/bus/usb") / node});
  }
  return parts;
}

void check_camera(const UsbDevice& camera, std::vector<Finding>& findings) {
  const std::string name = camera.product == "02bf" ? "Kinect for Windows" : "Kinect for Xbox 360";
  findings.push_back({Level::kOk, "kinect", name + " camera at " + camera.node.string(), ""});
  if (std::atoi(camera.speed_mbps.c_str()) < 480)
    findings.push_back({Level::kFail, "kinect speed", "runs at " + camera.speed_mbps + " Mb/s, needs 480",
                        "plug it straight into a USB port of the PC, without a hub or extension"});
  else
    findings.push_back({Level::kOk, "kinect speed", camera.speed_mbps + " Mb/s", ""});
  if (access(camera.node.c_str(), R_OK | W_OK) == 0)
    findings.push_back({Level::kOk, "kinect permission", "may be opened", ""});
  else
    findings.push_back(
        {Level::kFail, "kinect permission", camera.node.string() + " may not be opened", kInstallRule});
}

void check_kinect(const std::string& root, std::vector<Finding>& findings) {
  const std::vector<UsbDevice> parts = kinect_parts(root);
  const auto camera = std::find_if(parts.begin(), parts.end(), is_camera);
  if (parts.empty())
    findings.push_back(
        {Level::kWarn, "kinect", "none on USB",
         "plug in its power supply and its USB cable; recordings and --source sim:lab work without"});
  else if (camera == parts.end())
    findings.push_back({Level::kFail, "kinect", "answers on USB, but without its camera",
                        "plug in the Kinect's own power supply: USB does not feed the camera"});
  else
    check_camera(*camera, findings);
}

void check_udev_rule(const std::string& root, std::vector<Finding>& findings) {
  bool ours = false, debian = false;
  for (const char* folder :
       {"/etc/udev/rules.d", "/usr/lib/udev/rules.d", "/lib/udev/rules.d", "/usr/local/lib/udev/rules.d"}) {
    ours = ours || fs::exists(root + folder + "/60-startrack.rules");
    debian = debian || fs::exists(root + folder + "/60-libfreenect0.5.rules");
  }
  if (ours)
    findings.push_back({Level::kOk, "udev rule", "60-startrack.rules", ""});
  else if (debian)
    findings.push_back({Level::kOk, "udev rule",
                        "Debian's, which leaves out the Kinect for Windows (60-startrack.rules has it)", ""});
  else
    findings.push_back({Level::kWarn, "udev rule", "none: only root may open a Kinect", kInstallRule});
}

void check_gspca(const std::string& root, std::vector<Finding>& findings) {
  if (fs::exists(root + "/sys/module/gspca_kinect"))
    findings.push_back(
        {Level::kWarn, "gspca_kinect", "the kernel's webcam driver holds the Kinect",
         "echo blacklist gspca_kinect | sudo tee /etc/modprobe.d/startrack.conf && sudo rmmod gspca_kinect"});
  else
    findings.push_back({Level::kOk, "gspca_kinect", "not loaded", ""});
}

bool in_group_dialout() {
  if (geteuid() == 0) return true;
  const group* dialout = getgrnam("dialout");
  if (dialout == nullptr) return false;
  std::vector<gid_t> groups(static_cast<std::size_t>(std::max(0, getgroups(0, nullptr))));
  const int count = getgroups(static_cast<int>(groups.size()), groups.data());
  groups.resize(static_cast<std::size_t>(std::max(0, count)));
  return std::find(groups.begin(), groups.end(), dialout->gr_gid) != groups.end();
}

void check_port(const std::string& root, const fs::path& port, std::vector<Finding>& findings) {
  if (access(port.c_str(), R_OK | W_OK) == 0)
    findings.push_back({Level::kOk, "serial port", port.string(), ""});
  else
    findings.push_back({Level::kFail, "serial port", port.string() + " may not be opened", kJoinDialout});
  const std::string latency_ms =
      first_line(root + "/sys/bus/usb-serial/devices/" + port.filename().string() + "/latency_timer");
  if (!latency_ms.empty() && latency_ms != "1")
    findings.push_back({Level::kWarn, "serial latency",
                        port.string() + " holds bytes back for " + latency_ms + " ms", kInstallRule});
}

void check_serial(const std::string& root, std::vector<Finding>& findings) {
  std::vector<fs::path> ports;
  for (const fs::path& entry : entries_of(root + "/dev")) {
    const std::string name = entry.filename().string();
    if (name.starts_with("ttyUSB") || name.starts_with("ttyACM") || name.starts_with("rfcomm"))
      ports.push_back(entry);
  }
  if (!ports.empty()) {
    for (const fs::path& port : ports) check_port(root, port, findings);
    return;
  }
  const bool brltty = fs::exists(root + "/usr/bin/brltty") || fs::exists(root + "/sbin/brltty");
  findings.push_back(
      {Level::kWarn, "serial port", "no USB serial cable found",
       brltty ? "plug in the robot's cable; if it is, brltty takes such cables: sudo apt-get remove brltty"
              : "plug in the robot's cable; --robot sim works without"});
  if (!in_group_dialout())
    findings.push_back({Level::kWarn, "dialout group", "you are not in the group dialout", kJoinDialout});
}

}  // namespace

std::vector<Finding> check_devices(const std::string& root) {
  std::vector<Finding> findings;
  check_kinect(root, findings);
  check_udev_rule(root, findings);
  check_gspca(root, findings);
  check_serial(root, findings);
  return findings;
}

}  // namespace st
