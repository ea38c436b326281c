// `startrack report RUN`: the page of a run that has ended, or of one that was interrupted.
#include <cstdio>

#include "tools/report/run_report.hpp"
#include "tools/startrack/commands.hpp"

namespace st {

void add_report(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("report", "Make one self-contained page (report.html) of a run");
  command->footer("Example:\n  startrack report runs/20240309-080706-kinect-0");
  auto folder = std::make_shared<std::string>();
  command->add_option("RUN", *folder, "the folder of the run")->required();
  command->callback([folder, &exit_code] {
    std::printf("report: %s\n", write_report(*folder).c_str());
    exit_code = 0;
  });
}

}  // namespace st
