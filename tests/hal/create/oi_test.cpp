#include "hal/create/oi.hpp"

#include <CppUTest/TestHarness.h>

#include <initializer_list>
#include <vector>

using namespace st;

namespace {

void check_bytes(std::initializer_list<int> expected, const oi::Command& command) {
  LONGS_EQUAL(static_cast<long>(expected.size()), static_cast<long>(command.size));
  std::size_t i = 0;
  for (const int byte : expected) LONGS_EQUAL(byte, command.bytes[i++]);
}

int length(RobotModel model, int opcode, std::vector<std::uint8_t> data = {}) {
  return oi::data_length(model, static_cast<std::uint8_t>(opcode), data);
}

}  // namespace

TEST_GROUP(Oi){};

TEST(Oi, DriveMatchesTheVectorOfTheSpecification) {
  check_bytes({137, 255, 56, 1, 244}, oi::drive(-200, 500, 0.258));
}

TEST(Oi, DriveDirectSendsTheRightWheelFirstAndClamps) {
  check_bytes({145, 0, 200, 255, 156}, oi::drive_direct(-100, 200));
  check_bytes({145, 1, 244, 254, 12}, oi::drive_direct(-900, 900));
  check_bytes({145, 0, 0, 0, 0}, oi::halt());
}

TEST(Oi, DriveKeepsTheOuterWheelBelowItsLimit) {
  // 500 mm/s on a radius of one wheel base asks 750 mm/s of the outer wheel: two thirds are left.
  const oi::Command c = oi::drive(500, 235, 0.235);
  LONGS_EQUAL(333, c.bytes[1] << 8 | c.bytes[2]);
  check_bytes({137, 1, 244, 128, 0}, oi::drive(500, oi::kStraight, 0.235));
  check_bytes({137, 1, 244, 255, 255}, oi::drive(500, oi::kSpinRight, 0.235));
  check_bytes({137, 0, 100, 248, 48}, oi::drive(100, -9999, 0.235));
}

TEST(Oi, ListsCarryTheirCount) {
  const std::uint8_t packets[] = {29, 13};
  check_bytes({148, 2, 29, 13}, oi::stream(packets));
  check_bytes({149, 2, 29, 13}, oi::query(packets));
  check_bytes({142, 35}, oi::sensors(35));
  check_bytes({150, 0}, oi::pause_stream(false));
  check_bytes({128, 128, 128}, oi::start_run(3));
}

TEST(Oi, OneOpcodeHasTwoLengths) {
  LONGS_EQUAL(1, length(RobotModel::kCreate1, 136));
  LONGS_EQUAL(0, length(RobotModel::kCreate2, 136));
}

TEST(Oi, LengthsFollowTheData) {
  LONGS_EQUAL(2, length(RobotModel::kCreate1, 140));
  LONGS_EQUAL(2 + 2 * 5, length(RobotModel::kCreate1, 140, {0, 5}));
  LONGS_EQUAL(1 + 7, length(RobotModel::kCreate2, 148, {7}));
  LONGS_EQUAL(1 + 13, length(RobotModel::kCreate1, 152, {13}));
  LONGS_EQUAL(15, length(RobotModel::kCreate2, 167));
  LONGS_EQUAL(4, length(RobotModel::kCreate2, 145));
  LONGS_EQUAL(-1, length(RobotModel::kCreate1, 173));
  LONGS_EQUAL(-1, length(RobotModel::kCreate2, 152));
  LONGS_EQUAL(-1, length(RobotModel::kCreate2, 42));
}

TEST(Oi, GroupsHaveTheSizesOfTheSpecification) {
  const int groups[][2] = {{0, 26}, {1, 10}, {2, 6}, {3, 10}, {4, 14}, {5, 12}, {6, 52}};
  for (const auto& g : groups) {
    LONGS_EQUAL(g[1], oi::packet_size(RobotModel::kCreate1, g[0]));
    LONGS_EQUAL(g[1], oi::packet_size(RobotModel::kCreate2, g[0]));
  }
  const int create2_only[][2] = {{100, 80}, {101, 28}, {106, 12}, {107, 9}};
  for (const auto& g : create2_only) {
    LONGS_EQUAL(0, oi::packet_size(RobotModel::kCreate1, g[0]));
    LONGS_EQUAL(g[1], oi::packet_size(RobotModel::kCreate2, g[0]));
  }
  for (const int none : {102, 103, 104, 105, 59, 255})
    LONGS_EQUAL(0, oi::packet_size(RobotModel::kCreate2, none));
  LONGS_EQUAL(0, oi::packet_size(RobotModel::kCreate1, 43));
}

TEST(Oi, SignednessFollowsTheSpecification) {
  for (const int packet : {19, 20, 23, 24, 39, 40, 41, 42, 43, 44, 54, 55, 56, 57})
    CHECK(oi::packet_is_signed(packet));
  for (const int packet : {7, 17, 21, 22, 25, 26, 27, 31, 33, 35, 46, 51, 52, 58})
    CHECK_FALSE(oi::packet_is_signed(packet));
}

TEST(Oi, BaudCodes) {
  LONGS_EQUAL(300, oi::baud_of_code(0));
  LONGS_EQUAL(19200, oi::baud_of_code(7));
  LONGS_EQUAL(57600, oi::baud_of_code(10));
  LONGS_EQUAL(115200, oi::baud_of_code(11));
  LONGS_EQUAL(0, oi::baud_of_code(12));
}
