// startrack: one program, one subcommand per file in this folder.
#include <clocale>
#include <cstdio>
#include <string>

#include "hal/error.hpp"
#include "tools/startrack/commands.hpp"

namespace {

bool is_subcommand(const CLI::App& app, const std::string& word) {
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (command->get_name() == word) return true;
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  std::setlocale(LC_ALL, "C");  // libfreenect and every number we print want a decimal point
  CLI::App app{
      "startrack: tracks and reconstructs what moves before one fixed Kinect, and drives an iRobot Create"};
  app.require_subcommand(1);
  int exit_code = 0;
  st::add_run(app, exit_code);
  st::add_replay(app, exit_code);
  st::add_doctor(app, exit_code);
  st::add_record(app, exit_code);
  st::add_simulate(app, exit_code);
  st::add_evaluate(app, exit_code);
  st::add_report(app, exit_code);
  st::add_create_sim(app, exit_code);
  st::add_drive(app, exit_code);
  st::add_robot(app, exit_code);
  st::add_calibrate(app, exit_code);
  st::add_cut(app, exit_code);
  st::add_bench(app, exit_code);
  st::add_models(app, exit_code);
  try {
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    if (argc > 1 && argv[1][0] != '-' && !is_subcommand(app, argv[1])) {
      std::fprintf(stderr, "startrack: %s: no such subcommand; startrack --help lists them\n", argv[1]);
      return static_cast<int>(st::ExitCode::kBadInput);
    }
    std::fprintf(stderr, "startrack: %s; see startrack --help\n", error.what());
    return static_cast<int>(st::ExitCode::kBadInput);
  } catch (const st::Failure& failure) {
    std::fprintf(stderr, "startrack: %s\n", failure.what());
    return static_cast<int>(failure.code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "startrack: %s\n", error.what());
    return static_cast<int>(st::ExitCode::kBadInput);
  }
}
