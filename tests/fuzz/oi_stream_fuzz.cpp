#include "hal/create/oi_stream.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace st;
using namespace st::fuzz;

namespace {

// The first byte chooses the model, the rest is what comes over the line.
std::string stream(char model, const std::string& payload) {
  std::string bytes = std::string("\x13") + static_cast<char>(payload.size()) + payload;
  unsigned sum = 0;
  for (const char byte : bytes) sum += static_cast<std::uint8_t>(byte);
  bytes += static_cast<char>(256 - (sum & 255));
  return model + bytes + bytes + bytes;
}

}  // namespace

ST_FUZZ(oi_stream, stream(0, std::string("\x07\x00\x13\x00\x05\x14\xff\xfe", 8)),
        stream(1, std::string("\x2b\x01\x02\x2c\xff\xff\x07\x13", 8)), stream(1, std::string(1, 100))) {
  if (data.empty()) return;
  const RobotModel model = (data[0] & 1) != 0 ? RobotModel::kCreate2 : RobotModel::kCreate1;
  StreamParser parser(model);
  SensorState state;
  std::uint64_t frames = 0;
  for (const std::uint8_t byte : data.subspan(1)) {
    parser.push(byte);
    while (parser.next(state)) {
      ++frames;
      require(state.present != 0, "a good frame holds a packet");
    }
  }
  require(frames == parser.good_frames(), "every good frame is handed over once");
  // 4 bytes make the least frame: header, length, packet with one byte of data, checksum come to 5.
  require(parser.bad_bytes() + 5 * frames <= data.size() - 1, "no byte is counted twice");
}
