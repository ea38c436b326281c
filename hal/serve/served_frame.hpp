// What a client of `run --serve` gets and gives: a frame as a line of JSON, a command as a line of words.
#pragma once

#include <string>
#include <string_view>

#include "algo/core/records.hpp"
#include "hal/serve/client_command.hpp"

namespace st {

// What the loop knows of the robot in a frame.
struct ServedRobot {
  int object = 0;  // the tracked object that is the robot; 0: not known yet
  bool seen = false;
  Pose2 base;      // floor frame, when the frame was taken
  Pose2 base_now;  // carried on by the wheels to now
  double told_v_mps = 0, told_w_rps = 0;
  const char* state = "none";    // what it is doing
  const char* held_by = "none";  // the safety rule that holds it
};

struct ServedFrame {
  FrameReport report;
  ServedRobot robot;
};

// One line, with LF.
std::string json_line(const ServedFrame& frame);
// A line from a client: true when it is a command, else `error` says why not. One that asks for too much is a
// command too, but is not to be obeyed: `error` says so.
bool parse_client_line(std::string_view line, ClientCommand& command, std::string& error);

}  // namespace st
