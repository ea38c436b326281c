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
    SensorState decoded;
    const int end = 2 + bytes_[1];
    for (int at = 2; at < end;) {
      const int size = oi::packet_size(model_, bytes_[at]);
      decode_packet(model_, bytes_[at], {bytes_ + at + 1, static_cast<std::size_t>(size)}, decoded);
      at += 1 + size;
    }
    if (doubtful(decoded)) {
      if (size_ <= end + kHeaderBytes && header_at(end + 1)) return false;
      if (!header_at(end + 1)) {
        drop(1);
        ++bad_bytes_;
        continue;
      }
    }
    state = before_ = decoded;
    if (!known_length(0)) {
      lengths_[1] = lengths_[0];
      lengths_[0] = bytes_[1];
    }
    drop(end + 1);
    ++good_frames_;
    return true;
  }
}

void StreamParser::expect(std::span<const std::uint8_t> packets) {
  Request request;
  for (const std::uint8_t packet : packets) {
    const int data = oi::packet_size(model_, packet);
    if (data == 0) continue;  // the robot leaves out what it does not know
    if (request.count == static_cast<int>(sizeof request.packets)) return;
    request.packets[request.count++] = packet;
    request.bytes += 1 + data;
  }
  if (request.count == 0) return;
  requests_[1] = requests_[0];
  requests_[0] = request;
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
  const bool any = requests_[0].count == 0;
  bool fits[2];
  for (int k = 0; k < 2; ++k) fits[k] = requests_[k].count > 0 && requests_[k].bytes == bytes[1];
  if (!any && !fits[0] && !fits[1]) return Verdict::kBad;
  int at = 2;
  for (int packet = 0; at < end; ++packet) {
    if (at >= size) return Verdict::kIncomplete;
    const int data = oi::packet_size(model_, bytes[at]);
    for (int k = 0; k < 2; ++k)
      fits[k] = fits[k] && packet < requests_[k].count && requests_[k].packets[packet] == bytes[at];
    if (data == 0 || (!any && !fits[0] && !fits[1])) return Verdict::kBad;
    at += 1 + data;
  }
  if (at != end || bytes[1] == 0) return Verdict::kBad;
  if (size < end + 1) return Verdict::kIncomplete;
  unsigned sum = 0;
  for (int i = 0; i <= end; ++i) sum += bytes[i];
  return (sum & 255) == 0 ? Verdict::kGood : Verdict::kBad;
}

bool StreamParser::doubtful(const SensorState& state) const {
  for (int id = oi::kFirstPacket; id <= oi::kLastPacket; ++id) {
    if (!state.has(id)) continue;
    const int before = before_.value(id);
    if (!oi::plausible(id, state.value(id), before_.has(id) ? &before : nullptr)) return true;
  }
  const int end = 2 + bytes_[1];
  for (int at = 1; at < end; ++at)  // a 19 in the checksum's place takes no value's
    if (header_at(at)) return true;
  return false;
}

// Whether the bytes from there on, as far as they have come, are how a frame like the ones lately begins.
bool StreamParser::header_at(int at) const {
  if (at < size_ && bytes_[at] != kHeader) return false;
  if (at + 1 < size_ && bytes_[at + 1] != bytes_[1] && !known_length(at)) return false;
  return at + 2 >= size_ || bytes_[at + 2] == bytes_[2] ||
         (requests_[0].count > 0 && bytes_[at + 2] == requests_[0].packets[0]);
}

bool StreamParser::known_length(int start) const {
  const int length = bytes_[start + 1];
  return length != 0 && (length == lengths_[0] || length == lengths_[1]);
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
