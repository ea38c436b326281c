#include "hal/create/oi_stream.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "hal/sim/random.hpp"

using namespace st;

namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& to, const Bytes& more) {
  for (const std::uint8_t byte : more) to.push_back(byte);
}

std::vector<SensorState> parse(StreamParser& parser, const Bytes& bytes) {
  std::vector<SensorState> frames;
  SensorState state;
  for (const std::uint8_t byte : bytes) {
    parser.push(byte);
    while (parser.next(state)) frames.push_back(state);
  }
  return frames;
}

// A frame around the given ids and data, built here from the specification and not by the code under test.
Bytes frame(const Bytes& payload) {
  Bytes out;
  out.push_back(19);
  out.push_back(static_cast<std::uint8_t>(payload.size()));
  append(out, payload);
  unsigned sum = 0;
  for (const std::uint8_t b : out) sum += b;
  out.push_back(static_cast<std::uint8_t>(256 - (sum & 255)));
  return out;
}

// The data of a packet or group: this value, or the nearest that is plausible there.
void append_values(Bytes& to, int packet, int value) {
  const oi::PacketRange range = oi::packet_range(RobotModel::kCreate2, packet);
  for (int id = range.first; id <= range.last; ++id) {
    const oi::PacketInfo& info = *oi::packet_info(RobotModel::kCreate2, id);
    const int v = info.low == info.high ? value : std::clamp<int>(value, info.low, info.high);
    if (oi::packet_size(RobotModel::kCreate2, id) == 2) to.push_back(static_cast<std::uint8_t>(v >> 8));
    to.push_back(static_cast<std::uint8_t>(v));
  }
}

// Frame i of a recording: a number in a packet where anything goes, both encoders, and 19s in the payload.
Bytes numbered(int i) {
  const auto low = static_cast<std::uint8_t>(i & 255), high = static_cast<std::uint8_t>(i >> 8);
  return frame({40, high, low, 43, 19, 19, 44, 19, low, 24, 19, 35, 2});
}

}  // namespace

TEST_GROUP(OiStream){};

TEST(OiStream, ReadsTheVectorOfTheSpecification) {
  StreamParser parser(RobotModel::kCreate2);
  const auto frames = parse(parser, {19, 5, 29, 2, 25, 13, 0, 163});
  UNSIGNED_LONGS_EQUAL(1, frames.size());
  LONGS_EQUAL(537, frames[0].value(29));
  LONGS_EQUAL(0, frames[0].value(13));
  CHECK(frames[0].has(29));
  CHECK_FALSE(frames[0].has(28));
}

TEST(OiStream, RefusesAWrongChecksumAndTheRuleWithoutTheHeader) {
  StreamParser parser(RobotModel::kCreate1);
  UNSIGNED_LONGS_EQUAL(0, parse(parser, {19, 5, 29, 2, 25, 13, 0, 164}).size());
  parser.clear();
  UNSIGNED_LONGS_EQUAL(0, parse(parser, {19, 5, 29, 2, 25, 13, 0, 182}).size());
}

TEST(OiStream, DecodesSignsAndGroups) {
  StreamParser parser(RobotModel::kCreate2);
  Bytes payload{3};
  append(payload, {2, 0x3a, 0x98, 0xff, 0x38, 0xfb, 0x0a, 0x8c, 0x0b, 0xb8});
  const auto frames = parse(parser, frame(payload));
  UNSIGNED_LONGS_EQUAL(1, frames.size());
  LONGS_EQUAL(2, frames[0].value(21));
  LONGS_EQUAL(15000, frames[0].value(22));
  LONGS_EQUAL(-200, frames[0].value(23));
  LONGS_EQUAL(-5, frames[0].value(24));
  LONGS_EQUAL(2700, frames[0].value(25));
  LONGS_EQUAL(3000, frames[0].value(26));
}

TEST(OiStream, NamesWhatTheRobotTouches) {
  SensorState state;
  const std::uint8_t bumps[] = {0x02};
  decode_packet(RobotModel::kCreate1, 7, bumps, state);
  CHECK(state.bump_left() && !state.bump_right() && !state.wheel_drop());
  const std::uint8_t caster[] = {0x10};
  decode_packet(RobotModel::kCreate1, 7, caster, state);
  CHECK(state.wheel_drop() && !state.bump_left());
  const std::uint8_t edge[] = {1};
  decode_packet(RobotModel::kCreate1, 11, edge, state);
  CHECK(state.cliff());
}

TEST(OiStream, AFalseHeaderDoesNotCostTheFrameBehindIt) {
  // `19 19 N ...`: the first 19 takes the second for its length.
  StreamParser parser(RobotModel::kCreate2);
  Bytes bytes{19};
  append(bytes, numbered(7));
  const auto frames = parse(parser, bytes);
  UNSIGNED_LONGS_EQUAL(1, frames.size());
  LONGS_EQUAL(7, frames[0].value(40));
}

// Whatever happens to one frame, its neighbours arrive, complete and unchanged, and no later than their own
// last byte.
TEST(OiStream, DamageCostsOnlyTheFrameItTouched) {
  sim::Random random(5);
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes bytes, damaged = numbered(1000);
    const std::size_t at = static_cast<std::size_t>(random.below(static_cast<int>(damaged.size())));
    const auto where = damaged.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random.below(4)) {
      case 0:
        damaged.erase(where);
        break;
      case 1:
        damaged.insert(where, *where);
        break;
      case 2:
        *where = static_cast<std::uint8_t>(*where ^ (1 << random.below(8)));
        break;
      default:
        damaged.resize(at);
    }
    append(bytes, numbered(1));
    append(bytes, damaged);
    append(bytes, numbered(2));
    append(bytes, numbered(3));
    StreamParser parser(RobotModel::kCreate2);
    const auto frames = parse(parser, bytes);
    // A cut exactly at a frame's end, or a repeat that is no damage, leaves at most the four that were sent.
    CHECK(frames.size() >= 3 && frames.size() <= 4);
    LONGS_EQUAL(1, frames.front().value(40));
    LONGS_EQUAL(2, frames[frames.size() - 2].value(40));
    LONGS_EQUAL(3, frames.back().value(40));
  }
}

// A frame cut anywhere, then good ones: not one of these is lost or held back, and nothing else is taken for
// a frame. Of every list that this program asks for, and with the list known or not.
TEST(OiStream, EveryTruncationOfEveryFrameCostsThatFrameAlone) {
  const std::vector<std::uint8_t> lists[] = {
      {35},  {35, 43, 44}, {7, 9, 10, 11, 12, 13, 14, 21, 22, 23, 24, 25, 26, 34, 35, 41, 42},
      {100}, {6},          {19, 20}};
  for (const auto& list : lists)
    for (const bool known : {false, true})
      for (const int fill : {0, 19, 255}) {
        Bytes payload;
        for (const std::uint8_t packet : list) {
          payload.push_back(packet);
          append_values(payload, packet, fill);
        }
        const Bytes whole = frame(payload);
        for (std::size_t from = 0; from < whole.size(); ++from)
          for (std::size_t to = from; to < whole.size(); ++to) {
            StreamParser parser(RobotModel::kCreate2);
            if (known) parser.expect(list);
            Bytes bytes = whole;
            append(bytes, Bytes(whole.begin() + static_cast<std::ptrdiff_t>(from),
                                whole.begin() + static_cast<std::ptrdiff_t>(to)));
            append(bytes, whole);
            append(bytes, whole);
            bytes.push_back(19);  // the next one: where a payload looks like a header, it decides
            UNSIGNED_LONGS_EQUAL(3, parse(parser, bytes).size());
          }
      }
}

// Once the list is known, of a million random bytes none pass for a frame, and the good frame behind them is
// taken with its last byte.
TEST(OiStream, AMillionRandomBytesBringNothingThatWasNotSent) {
  sim::Random random(31);
  StreamParser parser(RobotModel::kCreate2);
  const std::uint8_t list[] = {40, 43, 44, 24, 35};
  parser.expect(list);
  SensorState state;
  std::uint64_t sent = 0, taken = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    // Now and then what begins like a frame, so that chance does not have to find the header.
    const int kind = random.below(16);
    parser.push(static_cast<std::uint8_t>(kind == 0 ? 19 : kind == 1 ? 13 : random.below(256)));
    while (parser.next(state)) ++taken;
    if (i % 1000 != 999) continue;
    ++sent;
    const Bytes good = numbered(i / 1000);
    for (const std::uint8_t byte : good) {
      parser.push(byte);
      while (parser.next(state)) {
        ++taken;
        LONGS_EQUAL(i / 1000, state.value(40));
      }
    }
    UNSIGNED_LONGS_EQUAL(sent, taken);
  }
}

// A battery at 300 V is a damaged byte more often than a battery. Where the next frame begins right behind,
// it was a strange robot after all.
TEST(OiStream, WhatIsNotPlausibleWaitsForTheNextHeader) {
  StreamParser parser(RobotModel::kCreate2);
  const Bytes strange = frame({22, 0x75, 0x30, 35, 2}), sound = frame({22, 0x3a, 0x98, 35, 2});
  UNSIGNED_LONGS_EQUAL(0, parse(parser, strange).size());
  UNSIGNED_LONGS_EQUAL(0, parse(parser, {19, 5}).size());
  UNSIGNED_LONGS_EQUAL(1, parse(parser, {22}).size());
  StreamParser other(RobotModel::kCreate2);
  UNSIGNED_LONGS_EQUAL(1, parse(other, sound).size());
  UNSIGNED_LONGS_EQUAL(0, parse(other, frame({22, 0x27, 0x10, 35, 2})).size());  // 5 V less within a slot
  Bytes behind = {7};
  append(behind, sound);
  UNSIGNED_LONGS_EQUAL(1, parse(other, behind).size());
  UNSIGNED_LONGS_EQUAL(2, other.good_frames());
}

TEST(OiStream, FramesOfAnotherListThanAskedForAreRefused) {
  StreamParser parser(RobotModel::kCreate2);
  const std::uint8_t first[] = {40, 43, 44, 24, 35}, second[] = {35}, third[] = {7, 35};
  parser.expect(first);
  parser.expect(second);
  UNSIGNED_LONGS_EQUAL(1, parse(parser, numbered(1)).size());  // those of the list before are on their way
  UNSIGNED_LONGS_EQUAL(1, parse(parser, frame({35, 2})).size());
  UNSIGNED_LONGS_EQUAL(0, parse(parser, frame({34, 2})).size());
  parser.expect(third);
  UNSIGNED_LONGS_EQUAL(0, parse(parser, numbered(1)).size());
  UNSIGNED_LONGS_EQUAL(1, parse(parser, frame({7, 0, 35, 2})).size());
}

TEST(OiStream, NoiseAndTextOfTheRobotBetweenFramesCostNone) {
  sim::Random random(9);
  Bytes bytes;
  for (int i = 0; i < 500; ++i) {
    for (int n = random.below(40); n > 0; --n)
      bytes.push_back(static_cast<std::uint8_t>(32 + random.below(90)));
    append(bytes, numbered(i));
  }
  StreamParser parser(RobotModel::kCreate2);
  const auto frames = parse(parser, bytes);
  UNSIGNED_LONGS_EQUAL(500, frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) LONGS_EQUAL(static_cast<int>(i), frames[i].value(40));
  UNSIGNED_LONGS_EQUAL(500, parser.good_frames());
  UNSIGNED_LONGS_EQUAL(bytes.size() - 500 * numbered(0).size(), parser.bad_bytes());
}

TEST(OiStream, AnyBytesWhateverKeepItWithinItsMemory) {
  sim::Random random(11);
  for (const RobotModel model : {RobotModel::kCreate1, RobotModel::kCreate2}) {
    StreamParser parser(model);
    SensorState state;
    for (int i = 0; i < 200000; ++i) {
      // Headers and lengths far more often than chance, so that long false frames come about.
      const int kind = random.below(4);
      parser.push(static_cast<std::uint8_t>(kind == 0   ? 19
                                            : kind == 1 ? 7 + random.below(52)
                                                        : random.below(256)));
      while (parser.next(state)) {
      }
    }
  }
}
