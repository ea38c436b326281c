// The program under test, started as a person starts it.
#pragma once

#include <string>
#include <vector>

namespace st::test {

struct Said {
  int code = -1;         // exit code; 128 + signal when one ended it
  std::string out, err;  // stdout, stderr
};

// Runs startrack with these arguments (no shell in between) to its end.
Said startrack(const std::vector<std::string>& arguments);

// Starts it and leaves it running; its output goes to `folder`/stdout and /stderr.
class Running {
 public:
  Running(const std::vector<std::string>& arguments, const std::string& folder);
  ~Running();  // kills it if it still runs
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void send(int signal) const;
  bool ended();  // without waiting
  Said wait();

 private:
  std::string folder_;
  int pid_ = -1;
  bool reaped_ = false;
  int status_ = 0;
};

std::string content(const std::string& file);  // empty when it is not there
std::size_t lines_of(const std::string& text);

}  // namespace st::test
