// Lines of a text file, one after the other in fixed memory, with the byte offset that each begins at.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace st {

// What a parser of one line found in it.
enum class LineKind { kEntry, kBlank, kForeign };

class LineReader {
 public:
  // Longer lines come cut off at this length; the rest of them is dropped.
  static constexpr std::size_t kMaxLine = 1 << 16;

  LineReader() = default;
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  // False when the file cannot be opened.
  bool open(const std::string& path);
  bool is_open() const { return fd_ >= 0; }

  // The next line without its LF; the view holds until the next call. False at the end of the file.
  bool next(std::string_view& line);
  // Where the line that next() returned last begins.
  std::uint64_t offset() const { return line_offset_; }

 private:
  bool fill();

  int fd_ = -1;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::uint64_t offset_ = 0, line_offset_ = 0;  // of begin_; of the last line
};

// Reads the whole file into `buffer`, at most its size. The result is the number of bytes; -1 when the file
// cannot be read, -2 when it is larger than the buffer.
std::int64_t read_whole_file(const std::string& path, std::vector<std::uint8_t>& buffer);

}  // namespace st
