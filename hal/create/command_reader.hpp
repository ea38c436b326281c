// Cuts what a host sends into whole commands. There is no other mark than each command's own length.
#pragma once

#include <cstdint>
#include <span>

#include "hal/create/oi.hpp"

namespace st::oi {

class CommandReader {
 public:
  explicit CommandReader(RobotModel model) : model_(model) {}

  // Takes one byte. True when it completed a command: command() is that until the next byte. An opcode that
  // the model does not know is passed over, byte by byte, as the robot does.
  bool push(std::uint8_t byte) {
    if (whole_) size_ = 0;
    whole_ = false;
    bytes_[size_++] = byte;
    const int data = data_length(model_, bytes_[0], {bytes_ + 1, size_ - 1});
    if (data < 0) size_ = 0;
    whole_ = data >= 0 && size_ > static_cast<std::size_t>(data);
    return whole_;
  }
  std::span<const std::uint8_t> command() const { return {bytes_, size_}; }
  bool in_the_middle() const { return size_ > 0 && !whole_; }
  void forget() { size_ = 0, whole_ = false; }

 private:
  static constexpr std::size_t kLongest = 3 + 2 * 255;  // Song: number, length, that many notes
  RobotModel model_;
  std::uint8_t bytes_[kLongest]{};
  std::size_t size_ = 0;
  bool whole_ = false;
};

}  // namespace st::oi
