#include "hal/recording/line_reader.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace st {
namespace {

ssize_t read_some(int fd, void* to, std::size_t bytes) {
  ssize_t n;
  do n = read(fd, to, bytes);
  while (n < 0 && errno == EINTR);
  return n;
}

}  // namespace

LineReader::~LineReader() {
  if (fd_ >= 0) close(fd_);
}

bool LineReader::open(const std::string& path) {
  fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd_ < 0) return false;
  buffer_.resize(kMaxLine);
  return true;
}

bool LineReader::fill() {
  if (begin_ > 0) std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (end_ == buffer_.size()) return false;
  const ssize_t n = read_some(fd_, buffer_.data() + end_, buffer_.size() - end_);
  if (n <= 0) return false;
  end_ += static_cast<std::size_t>(n);
  return true;
}

bool LineReader::next(std::string_view& line) {
  if (fd_ < 0) return false;
  line_offset_ = offset_;
  std::size_t searched = 0;
  for (;;) {
    const char* from = buffer_.data() + begin_ + searched;
    const auto* lf = static_cast<const char*>(std::memchr(from, '\n', end_ - begin_ - searched));
    if (lf != nullptr) {
      line = {buffer_.data() + begin_, static_cast<std::size_t>(lf - buffer_.data()) - begin_};
      begin_ += line.size() + 1;
      offset_ += line.size() + 1;
      return true;
    }
    searched = end_ - begin_;
    if (fill()) continue;
    if (searched == 0) return false;
    line = {buffer_.data() + begin_, searched};
    offset_ += searched;
    if (searched < buffer_.size()) {  // the last line, without LF
      begin_ = end_;
      return true;
    }
    // Too long: hand out what fits, and drop the rest up to the LF. `line` must stay readable, so count while
    // dropping.
    char c = 0;
    while (read_some(fd_, &c, 1) == 1) {
      ++offset_;
      if (c == '\n') break;
    }
    begin_ = end_ = buffer_.size();
    return true;
  }
}

std::int64_t read_whole_file(const std::string& path, std::vector<std::uint8_t>& buffer) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return -1;
  std::size_t at = 0;
  ssize_t n = 1;
  while (at < buffer.size() && (n = read_some(fd, buffer.data() + at, buffer.size() - at)) > 0)
    at += static_cast<std::size_t>(n);
  std::uint8_t beyond = 0;
  const bool larger = n > 0 && at == buffer.size() && read_some(fd, &beyond, 1) == 1;
  close(fd);
  if (n < 0) return -1;
  return larger ? -2 : static_cast<std::int64_t>(at);
}

}  // namespace st
