// What one step of preparing the machine came to. A step that is refused is no error: the run goes on with
// weaker promises, and the text says what was refused, why, and what to do.
#pragma once

#include <string>

namespace st {

struct SetupStep {
  bool ok = true;
  std::string line;      // what happened
  std::string remedy{};  // what to do about it; empty when all is well

  std::string text() const { return remedy.empty() ? line : line + "; " + remedy; }
};

// The remedy for a refused lock or priority.
inline constexpr const char* kInstallLimits =
    "sudo cp packaging/startrack-limits.conf /etc/security/limits.d/, join the group dialout, log in again";

}  // namespace st
