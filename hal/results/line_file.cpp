#include "hal/results/line_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "hal/error.hpp"

namespace st {
namespace {

std::string why(const std::string& path, int error) {
  if (error == ENOSPC || error == EDQUOT)
    return path + ": the disk is full; free some space and run again, or choose another disk with --out";
  return path + ": cannot write (" + std::strerror(error) + "); choose another folder with --out";
}

// True when every byte was taken. Short writes are continued: only an error ends them.
bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

}  // namespace

LineFile::LineFile(const std::string& path, Open how) : path_(path) {
  fd_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | (how == Open::kNew ? O_TRUNC : 0), 0644);
  if (fd_ < 0) throw Failure(ExitCode::kBadInput, why(path, errno));
  whole_bytes_ = ::lseek(fd_, 0, SEEK_END);
}

LineFile::LineFile(LineFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      whole_bytes_(other.whole_bytes_),
      path_(std::move(other.path_)),
      pending_(std::move(other.pending_)),
      error_(std::move(other.error_)) {}

LineFile::~LineFile() {
  if (fd_ < 0) return;
  flush();
  ::close(fd_);
}

bool LineFile::flush() {
  if (error_.empty() && !pending_.empty()) {
    if (write_all(fd_, pending_)) {
      whole_bytes_ += static_cast<off_t>(pending_.size());
    } else {
      error_ = why(path_, errno);
      if (::ftruncate(fd_, whole_bytes_) != 0) error_ += " (its last line may be cut)";
    }
  }
  pending_.clear();
  return error_.empty();
}

std::string partial_name(const std::string& name) { return name + ".part"; }

void write_whole_file(const std::string& path, std::string_view content) {
  const std::string partial = partial_name(path);
  const int fd = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) throw Failure(ExitCode::kBadInput, why(path, errno));
  bool ok = write_all(fd, content);
  int error = errno;
  if (::close(fd) != 0 && ok) ok = false, error = errno;
  if (ok && std::rename(partial.c_str(), path.c_str()) != 0) ok = false, error = errno;
  if (ok) return;
  ::unlink(partial.c_str());
  throw Failure(ExitCode::kBadInput, why(path, error));
}

std::string read_whole_file(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat info {};
  if (fd < 0 || ::fstat(fd, &info) != 0 || S_ISDIR(info.st_mode)) {
    const int error = fd >= 0 && S_ISDIR(info.st_mode) ? EISDIR : errno;
    if (fd >= 0) ::close(fd);
    throw Failure(ExitCode::kBadInput, path + ": cannot read (" + std::strerror(error) + "); check the name");
  }
  std::string content;
  content.reserve(static_cast<std::size_t>(info.st_size));
  char block[65536];
  ssize_t n = 0;
  while ((n = ::read(fd, block, sizeof block)) > 0 || (n < 0 && errno == EINTR))
    if (n > 0) content.append(block, static_cast<std::size_t>(n));
  const int error = errno;
  ::close(fd);
  if (n < 0) throw Failure(ExitCode::kBadInput, path + ": cannot read (" + std::strerror(error) + ")");
  return content;
}

}  // namespace st
