#include "hal/create/sim/uart_line.hpp"

namespace st::sim {
namespace {

constexpr double kBitsPerByte = 10;

// Level of the wire, `at` bit times after the falling edge of the start bit.
bool wire_level(std::uint8_t byte, double at) {
  if (at < 0 || at >= 9) return true;  // idle, stop bit
  return at >= 1 && (byte >> (static_cast<int>(at) - 1) & 1) != 0;
}

}  // namespace

int resample_byte(std::uint8_t byte, int sender_baud, int receiver_baud, std::uint8_t out[8]) {
  const double bit =
      static_cast<double>(sender_baud) / receiver_baud;  // the receiver's bit time in the sender's
  int count = 0;
  double at = 0;
  while (at < kBitsPerByte && count < 8) {
    if (wire_level(byte, at)) {
      at += 0.25 * bit;
      continue;
    }
    int value = 0;
    for (int k = 0; k < 8; ++k) value |= static_cast<int>(wire_level(byte, at + (k + 1.5) * bit)) << k;
    at += 9.5 * bit;
    if (wire_level(byte, at)) out[count++] = static_cast<std::uint8_t>(value);
    while (!wire_level(byte, at))
      at += 0.25 * bit;  // no stop bit: a break, and no start before the line was high
  }
  return count;
}

void UartLine::advance(double dt_s, int sender_baud, int receiver_baud, std::deque<std::uint8_t>& heard) {
  bits_ += dt_s * sender_baud;
  while (!waiting_.empty() && bits_ >= kBitsPerByte) {
    bits_ -= kBitsPerByte;
    const std::uint8_t byte = waiting_.front();
    waiting_.pop_front();
    deliver(byte, sender_baud, receiver_baud, heard);
  }
  if (waiting_.empty()) bits_ = 0;
}

void UartLine::deliver(std::uint8_t byte, int sender_baud, int receiver_baud,
                       std::deque<std::uint8_t>& heard) {
  if (noise_.drop > 0 && random_.uniform() < noise_.drop) return;
  if (noise_.flip > 0 && random_.uniform() < noise_.flip)
    byte = static_cast<std::uint8_t>(byte ^ 1 << random_.below(8));
  const int times = noise_.duplicate > 0 && random_.uniform() < noise_.duplicate ? 2 : 1;
  std::uint8_t bytes[8] = {byte};
  const int count = sender_baud == receiver_baud ? 1 : resample_byte(byte, sender_baud, receiver_baud, bytes);
  for (int i = 0; i < times; ++i) heard.insert(heard.end(), bytes, bytes + count);
}

}  // namespace st::sim
