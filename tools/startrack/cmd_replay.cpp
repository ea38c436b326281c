// startrack replay: the loop over a recording.
#include <memory>

#include "tools/startrack/session_command.hpp"

namespace st {

void add_replay(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SessionOptions>();
  CLI::App* command = app.add_subcommand("replay", "Track what moves in a recording");
  command->footer("Example:\n  startrack replay lab-square/rec --out runs/lab-square");
  command
      ->add_option("REC", options->source.spec, "folder with INDEX.txt (fakenect) or depth.txt (TUM RGB-D)")
      ->required();
  command
      ->add_option_function<std::string>(
          "--pace", [options](const std::string& pace) { options->source.real_pace = pace == "real"; },
          "fast, or real: as it was recorded")
      ->check(CLI::IsMember({"fast", "real"}));
  add_session_options(*command, *options);
  command->callback([options, &exit_code] { exit_code = run_and_report(*options); });
}

}  // namespace st
