// What goes wrong outside the loop travels as one exception type. It carries the exit code of the contract
// and one line that says what, where and what to do. Never thrown on the compute thread after seal().
#pragma once

#include <stdexcept>
#include <string>

namespace st {

enum class ExitCode : int {
  kDone = 0,
  kTrackFailed = 1,
  kBadInput = 2,
  kDeviceFault = 3,
  kInterrupted = 130
};

class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& line) : std::runtime_error(line), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace st
