// startrack doctor: what is missing on this PC and what to do.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hal/system/checks.hpp"
#include "tools/startrack/commands.hpp"

namespace st {
namespace {

const char* name_of(Finding::Level level) {
  switch (level) {
    case Finding::Level::kOk:
      return "OK";
    case Finding::Level::kWarn:
      return "WARN";
    case Finding::Level::kFail:
      return "FAIL";
  }
  return "FAIL";
}

void print_lines(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    std::printf("%-4s  %-18s  %s\n", name_of(finding.level), finding.check.c_str(), finding.found.c_str());
    if (!finding.remedy.empty()) std::printf("%26s-> %s\n", "", finding.remedy.c_str());
  }
}

void print_json(const std::vector<Finding>& findings) {
  nlohmann::json checks = nlohmann::json::array();
  bool ok = true;
  for (const Finding& finding : findings) {
    ok = ok && finding.level != Finding::Level::kFail;
    checks.push_back({{"check", finding.check},
                      {"status", name_of(finding.level)},
                      {"found", finding.found},
                      {"remedy", finding.remedy}});
  }
  std::printf("%s\n", nlohmann::json{{"ok", ok}, {"checks", checks}}.dump(2).c_str());
}

struct Options {
  bool json = false;
  std::string folder = ".";
};

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("doctor", "what is missing on this PC and what to do");
  command->add_flag("--json", options->json, "one JSON object instead of lines");
  command->add_option("--dir", options->folder, "folder whose disk is tried")->capture_default_str();
  command->footer("Example: startrack doctor");
  command->callback([options, &exit_code] {
    std::vector<Finding> findings = check_devices("");
    for (const std::vector<Finding>& more : {check_settings(""), try_machine(options->folder)})
      findings.insert(findings.end(), more.begin(), more.end());
    if (options->json)
      print_json(findings);
    else
      print_lines(findings);
    exit_code = 0;  // it did its work; what it found stands in the lines
  });
}

}  // namespace st
