// One direction of a serial line in simulated time: bytes leave at ten bits each, and a receiver that listens
// at another speed hears what its own sampling makes of the wave.
#pragma once

#include <cstdint>
#include <deque>
#include <span>

#include "hal/sim/random.hpp"

namespace st::sim {

// Chance per byte; of the cable, not of the speed.
struct LineNoise {
  double drop = 0, flip = 0, duplicate = 0;
};

class UartLine {
 public:
  UartLine(const LineNoise& noise, std::uint64_t seed) : noise_(noise), random_(seed, 0x0a47) {}

  void send(std::span<const std::uint8_t> bytes) {
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
  }
  std::size_t waiting() const { return waiting_.size(); }
  void discard() { waiting_.clear(); }

  // Lets dt_s pass, and appends what the receiver has heard by then.
  void advance(double dt_s, int sender_baud, int receiver_baud, std::deque<std::uint8_t>& heard);

 private:
  void deliver(std::uint8_t byte, int sender_baud, int receiver_baud, std::deque<std::uint8_t>& heard);

  LineNoise noise_;
  Random random_;
  std::deque<std::uint8_t> waiting_;
  double bits_ = 0;  // of the byte on the wire, already sent
};

// What a receiver makes of one byte (start bit, eight data bits low first, stop bit) sent at another speed.
// Bytes without a stop bit are dropped, as by a UART that reports framing errors to nobody. At most 8 bytes;
// the count is returned.
int resample_byte(std::uint8_t byte, int sender_baud, int receiver_baud, std::uint8_t out[8]);

}  // namespace st::sim
