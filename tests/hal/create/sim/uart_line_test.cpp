#include "hal/create/sim/uart_line.hpp"

#include <CppUTest/TestHarness.h>

#include <vector>

using namespace st::sim;

TEST_GROUP(UartLine){};

TEST(UartLine, AtTheSameSpeedEveryByteArrivesAsItIs) {
  std::uint8_t out[8];
  for (int b = 0; b < 256; ++b) {
    LONGS_EQUAL(1, resample_byte(static_cast<std::uint8_t>(b), 115200, 115200, out));
    LONGS_EQUAL(b, out[0]);
  }
}

TEST(UartLine, AtTwiceTheSpeedBitsAreHeardTwice) {
  // 0xff at half speed: two low samples (the start bit), then high.
  std::uint8_t out[8];
  LONGS_EQUAL(1, resample_byte(0xff, 57600, 115200, out));
  LONGS_EQUAL(0xfe, out[0]);
  // 0x00: nothing but a break, without a stop bit.
  LONGS_EQUAL(0, resample_byte(0x00, 57600, 115200, out));
}

TEST(UartLine, BytesTakeTheirTime) {
  UartLine line({}, 1);
  std::deque<std::uint8_t> heard;
  const std::vector<std::uint8_t> bytes(100, 42);
  line.send(bytes);
  line.advance(0.005, 57600, 57600, heard);
  UNSIGNED_LONGS_EQUAL(28, heard.size());
  line.advance(0.1, 57600, 57600, heard);
  UNSIGNED_LONGS_EQUAL(100, heard.size());
  // Idle time is not saved up.
  line.advance(1.0, 57600, 57600, heard);
  line.send(bytes);
  line.advance(0.001, 57600, 57600, heard);
  UNSIGNED_LONGS_EQUAL(105, heard.size());
}

TEST(UartLine, NoiseHasItsShare) {
  LineNoise noise;
  noise.drop = 0.1;
  noise.flip = 0.1;
  UartLine line(noise, 7);
  std::deque<std::uint8_t> heard;
  line.send(std::vector<std::uint8_t>(10000, 0x55));
  line.advance(10, 57600, 57600, heard);
  DOUBLES_EQUAL(9000, static_cast<double>(heard.size()), 150);
  double wrong = 0;
  for (const std::uint8_t b : heard) wrong += b != 0x55;
  DOUBLES_EQUAL(900, wrong, 150);
}
