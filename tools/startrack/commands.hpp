// The subcommands. Each add_*() registers one with its options, help and example, and a callback that runs it
// and stores its exit code. Callbacks throw st::Failure for what the user must mend; main() prints its line
// and maps the code.
#pragma once

#include <CLI/CLI.hpp>

namespace st {

void add_doctor(CLI::App& app, int& exit_code);
void add_record(CLI::App& app, int& exit_code);
void add_simulate(CLI::App& app, int& exit_code);

void add_evaluate(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);
void add_create_sim(CLI::App& app, int& exit_code);
void add_drive(CLI::App& app, int& exit_code);
void add_robot(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_calibrate_depth(CLI::App& calibrate, int& exit_code);

void add_cut(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);

void add_models(CLI::App& app, int& exit_code);

void add_replay(CLI::App& app, int& exit_code);
void add_run(CLI::App& app, int& exit_code);

}  // namespace st
