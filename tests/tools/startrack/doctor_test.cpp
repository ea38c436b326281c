#include <CppUTest/TestHarness.h>
#include <sys/wait.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

namespace {

struct Output {
  int code = -1;
  std::string text;
};

Output startrack(const std::string& arguments) {
  Output output;
  std::FILE* pipe = popen((std::string(STARTRACK_BINARY) + " " + arguments).c_str(), "r");
  char piece[512];
  while (std::fgets(piece, sizeof piece, pipe) != nullptr) output.text += piece;
  const int status = pclose(pipe);
  output.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return output;
}

}  // namespace

TEST_GROUP(Doctor){};

TEST(Doctor, JsonNamesEveryCheckWithItsStatusAndRemedy) {
  const Output output = startrack("doctor --json --dir /tmp");
  LONGS_EQUAL(0, output.code);
  const nlohmann::json all = nlohmann::json::parse(output.text);
  bool any_failed = false;
  for (const char* wanted :
       {"kinect", "udev rule", "gspca_kinect", "serial port", "cpu cores", "simd", "cpu governor",
        "huge pages", "memory", "real-time priority", "memory lock", "disk space"}) {
    bool found = false;
    for (const auto& check : all["checks"]) found = found || check["check"] == wanted;
    CHECK_TEXT(found, wanted);
  }
  for (const auto& check : all["checks"]) {
    const std::string status = check["status"];
    CHECK(status == "OK" || status == "WARN" || status == "FAIL");
    any_failed = any_failed || status == "FAIL";
  }
  CHECK(all["ok"] == !any_failed);
}

TEST(Doctor, LinesShowTheSame) {
  const Output output = startrack("doctor --dir /tmp");
  LONGS_EQUAL(0, output.code);
  CHECK(output.text.find("  kinect ") != std::string::npos);
  CHECK(output.text.find("  simd ") != std::string::npos);
}
