// What `run` and `replay` share on the command line, and how both end.
#pragma once

#include "firmware_like/session.hpp"
#include "tools/startrack/commands.hpp"

namespace st {

// Adds the options that both take. `options` outlives the command.
void add_session_options(CLI::App& command, SessionOptions& options);

// Runs it; prints the table of what came out, report and model, and the last line `run: PATH`. Returns the
// exit code.
int run_and_report(const SessionOptions& options);

}  // namespace st
