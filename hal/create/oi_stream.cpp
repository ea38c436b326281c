#include "hal/create/oi_stream.hpp"

#include <cstring>

namespace st {
namespace {

constexpr std::uint8_t kHeader = 19;

}  // namespace

void decode_packet(RobotModel model, int packet, std::span<const std::uint8_t> data, SensorState& state) {
  const oi::PacketRange range = oi::packet_range(model, packet);
  std::size_t at = 0;
  for (int id = range.first; id <= range.last; ++id) {
    const bool is_long = oi::packet_size(model, id) == 2;
    int value = data[at++];
    if (is_long) value = value << 8 | data[at++];
    const int half = is_long ? 1 << 15 : 1 << 7;
    if (oi::packet_is_signed(id) && value >= half) value -= 2 * half;
    state.set(id, value);
  }
}

void StreamParser::push(std::uint8_t byte) { bytes_[size_++] = byte; }

bool StreamParser::next(SensorState& state) {
  for (;;) {
    const Verdict verdict = judge(0);
    if (verdict == Verdict::kIncomplete && !skip_to_frame_behind()) return false;
    if (verdict == Verdict::kIncomplete) continue;
    if (verdict == Verdict::kBad) {
      drop(1);
      ++bad_bytes_;
      continue;
    }
    state = SensorState{};
    const int end = 2 + bytes_[1];
    for (int at = 2; at < end;) {
      const int size = oi::packet_size(model_, bytes_[at]);
      decode_packet(model_, bytes_[at], {bytes_ + at + 1, static_cast<std::size_t>(size)}, state);
      at += 1 + size;
    }
    if (!known_length(0)) {
      lengths_[1] = lengths_[0];
      lengths_[0] = bytes_[1];
    }
    drop(end + 1);
    ++good_frames_;
    return true;
  }
}

// Judges as early as the bytes allow, so that a 19 in the payload that poses as a header does not hold back
// the good frame behind it.
StreamParser::Verdict StreamParser::judge(int start) const {
  const std::uint8_t* bytes = bytes_ + start;
  const int size = size_ - start;
  if (size == 0) return Verdict::kIncomplete;
  if (bytes[0] != kHeader) return Verdict::kBad;
  if (size < 2) return Verdict::kIncomplete;
  const int end = 2 + bytes[1];
  int at = 2;
  while (at < end) {
    if (at >= size) return Verdict::kIncomplete;
    const int data = oi::packet_size(model_, bytes[at]);
    if (data == 0) return Verdict::kBad;
    at += 1 + data;
  }
  if (at != end || bytes[1] == 0) return Verdict::kBad;
  if (size < end + 1) return Verdict::kIncomplete;
  unsigned sum = 0;
  for (int i = 0; i <= end; ++i) sum += bytes[i];
  return (sum & 255) == 0 ? Verdict::kGood : Verdict::kBad;
}

bool StreamParser::known_length(int start) const {
  return bytes_[start + 1] == lengths_[0] || bytes_[start + 1] == lengths_[1];
}

// A start that waits for more bytes than any frame had lately gives way to a whole frame behind it: a false
// length may ask for 255 bytes, which are several frames.
bool StreamParser::skip_to_frame_behind() {
  if (size_ < 2 || known_length(0)) return false;
  for (int start = 1; start + 1 < size_; ++start) {
    if (bytes_[start] != kHeader || !known_length(start) || judge(start) != Verdict::kGood) continue;
    bad_bytes_ += static_cast<std::uint64_t>(start);
    drop(start);
    return true;
  }
  return false;
}

void StreamParser::drop(int count) {
  size_ -= count;
  std::memmove(bytes_, bytes_ + count, static_cast<std::size_t>(size_));
}

}  // namespace st
