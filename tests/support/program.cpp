#include "tests/support/program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>

#include "tests/support/temp_folder.hpp"

namespace st::test {
namespace {

void redirect(int to, const std::string& file) {
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (fd < 0 || dup2(fd, to) < 0) _exit(126);
  close(fd);
}

}  // namespace

Running::Running(const std::vector<std::string>& arguments, const std::string& folder) : folder_(folder) {
  std::vector<std::string> words{STARTRACK_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ != 0) return;
  redirect(STDOUT_FILENO, folder_ + "/stdout");
  redirect(STDERR_FILENO, folder_ + "/stderr");
  execv(argv[0], argv.data());
  _exit(127);
}

Running::~Running() {
  if (reaped_) return;
  send(SIGKILL);
  wait();
}

void Running::send(int signal) const {
  if (!reaped_) kill(pid_, signal);
}

bool Running::ended() {
  if (!reaped_) reaped_ = waitpid(pid_, &status_, WNOHANG) == pid_;
  return reaped_;
}

Said Running::wait() {
  if (!reaped_) reaped_ = waitpid(pid_, &status_, 0) == pid_;
  const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  return {code, content(folder_ + "/stdout"), content(folder_ + "/stderr")};
}

Said startrack(const std::vector<std::string>& arguments) {
  const TempFolder output;
  return Running(arguments, output.path()).wait();
}

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace st::test
