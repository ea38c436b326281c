// What the robot streams: frames `19, N, (packet id, data)*, checksum`, found again after any loss, and
// decoded.
#pragma once

#include <cstdint>
#include <span>

#include "hal/create/oi.hpp"

namespace st {

// The sensor values of one instant, by packet id 7-58, as the robot sent them (sign applied).
struct SensorState {
  std::uint64_t present = 0;  // bit id - 7
  std::int32_t values[oi::kLastPacket - oi::kFirstPacket + 1]{};

  bool has(int packet) const { return (present >> (packet - oi::kFirstPacket) & 1) != 0; }
  int value(int packet) const { return values[packet - oi::kFirstPacket]; }  // 0 when absent
  void set(int packet, int value) {
    present |= std::uint64_t{1} << (packet - oi::kFirstPacket);
    values[packet - oi::kFirstPacket] = value;
  }

  bool bump_right() const { return (value(oi::kBumpsWheelDrops) & 1) != 0; }
  bool bump_left() const { return (value(oi::kBumpsWheelDrops) & 2) != 0; }
  bool wheel_drop() const {
    return (value(oi::kBumpsWheelDrops) & 0x1c) != 0;
  }  // right, left, caster (Create 1)
  bool cliff() const {
    return value(oi::kCliffLeft) != 0 || value(oi::kCliffFrontLeft) != 0 ||
           value(oi::kCliffFrontRight) != 0 || value(oi::kCliffRight) != 0;
  }
};

// Data of a packet or group (without its id), which must have packet_size() bytes, into `state`.
void decode_packet(RobotModel model, int packet, std::span<const std::uint8_t> data, SensorState& state);

// Finds frames in a byte stream. After a false or damaged start it looks on from the very next byte, so that
// a loss, a flip, an insertion or text from the robot costs the frames it touched and no other. Both models
// are taken to count the header into the checksum: the Create 1 specification says otherwise, real Create 1s
// do. One sum in 256 is right by chance: a frame whose values are not plausible, or in which another one
// seems to begin, is good only when the next one begins right behind it.
class StreamParser {
 public:
  explicit StreamParser(RobotModel model) : model_(model) {}

  // Takes one byte; true when it completed a good frame or showed that a pending one was good: `state` holds
  // it then. Call next() until it is false before the next byte.
  void push(std::uint8_t byte);
  bool next(SensorState& state);  // takes a good frame that is complete

  // What the robot was last asked to stream. From then on a frame is good only when it holds exactly these
  // packets, or those of the request before, whose last frames may still be on their way: of damage that
  // happens to leave the checksum right, next to nothing passes. Before the first request any list will do.
  void expect(std::span<const std::uint8_t> packets);

  // Forgets a half-read frame: after the baud rate has changed.
  void clear() { size_ = 0; }

  std::uint64_t good_frames() const { return good_frames_; }
  std::uint64_t bad_bytes() const { return bad_bytes_; }  // bytes that belong to no good frame

 private:
  enum class Verdict { kIncomplete, kGood, kBad };
  Verdict judge(int start) const;
  bool known_length(int start) const;
  bool doubtful(const SensorState& state) const;
  bool header_at(int at) const;

  // The packets of one request, and how many bytes a frame then holds between its length and its checksum.
  struct Request {
    std::uint8_t packets[64]{};
    int count = 0, bytes = 0;
  };
  bool skip_to_frame_behind();
  void drop(int count);

  static constexpr int kLongestFrame = 3 + 255;
  static constexpr int kHeaderBytes = 3;  // 19, length, first packet
  RobotModel model_;
  std::uint8_t bytes_[kLongestFrame + kHeaderBytes]{};
  int size_ = 0;
  std::uint8_t
      lengths_[2]{};     // N of the newest good frames; two, since a driver may alternate between two lists
  Request requests_[2];  // the newest first; count 0: none
  SensorState before_;
  std::uint64_t good_frames_ = 0, bad_bytes_ = 0;
};

}  // namespace st
