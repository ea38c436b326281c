// Files that hold whole lines at any instant, also after `kill -9` and when the disk fills up.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>

namespace st {

// Appends lines to a new file. Lines gather in line() and reach the kernel by one write() in flush(); when
// that fails the file is cut back to its last whole line and takes no more. Not thread-safe: one owner.
class LineFile {
 public:
  enum class Open { kNew, kContinue };
  // Makes the file, or goes on after its last byte. Throws Failure (kBadInput) when it cannot be opened.
  explicit LineFile(const std::string& path, Open how = Open::kNew);
  LineFile(LineFile&& other) noexcept;
  LineFile& operator=(LineFile&&) = delete;
  ~LineFile();

  std::string& line() { return pending_; }             // append whole lines, '\n' included
  bool flush();                                        // false once a write has failed
  const std::string& error() const { return error_; }  // one line, empty while all is well

 private:
  int fd_ = -1;
  off_t whole_bytes_ = 0;
  std::string path_, pending_, error_;
};

// Writes a file that is there completely or not at all (a temporary name, then a rename). Throws Failure
// (kBadInput).
void write_whole_file(const std::string& path, std::string_view content);

// The whole content. Throws Failure (kBadInput) when it cannot be read.
std::string read_whole_file(const std::string& path);

// The temporary name that write_whole_file() uses for `name`.
std::string partial_name(const std::string& name);

}  // namespace st
