#include "hal/serve/pose_server.hpp"

#include <CppUTest/TestHarness.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>

using namespace st;

namespace {

// A program that connects, as any other would.
class Client {
 public:
  explicit Client(int port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }
  ~Client() { close(fd_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool connected() const { return connected_; }
  void say(const std::string& text) const {
    CHECK(send(fd_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size()));
  }
  // The next line; empty when none comes within two seconds or the server is gone.
  std::string line() {
    for (;;) {
      if (const std::size_t end = rest_.find('\n'); end != std::string::npos) {
        const std::string line = rest_.substr(0, end);
        rest_.erase(0, end + 1);
        return line;
      }
      pollfd ready{fd_, POLLIN, 0};
      char bytes[4096];
      if (poll(&ready, 1, 2000) <= 0) return {};
      const ssize_t n = recv(fd_, bytes, sizeof bytes, 0);
      if (n <= 0) return {};
      rest_.append(bytes, static_cast<std::size_t>(n));
    }
  }

 private:
  int fd_;
  bool connected_ = false;
  std::string rest_;
};

// Waits for a command that came after `since_ns`; its time is not later when none comes.
ClientCommand taken(PoseServer& server, std::int64_t since_ns = 0) {
  ClientCommand command;
  for (int i = 0; i < 2000 && command.monotonic_ns <= since_ns; ++i) {
    command = server.command().take();
    usleep(1000);
  }
  return command;
}

ServedFrame a_frame() {
  ServedFrame frame;
  frame.report.t_s = 1234.5;
  frame.report.index = 77;
  frame.report.age_us = 1000;
  frame.report.frame_us = 2500;
  ObjectSample sample;
  sample.id = 1;
  sample.state = TrackState::kGood;
  sample.in_tum = true;
  sample.T_floor_object = {rotation_z(0.5), {1, 2, 0.01}};
  sample.covariance[0] = 4e-6;
  sample.v_mps = 0.2;
  frame.report.objects.push_back(sample);
  sample = ObjectSample{};
  sample.id = 2;
  frame.report.objects.push_back(sample);
  frame.robot.object = 1;
  frame.robot.seen = true;
  frame.robot.base_now = {0.25, -0.5, 1.5};
  frame.robot.state = "driving";
  return frame;
}

}  // namespace

TEST_GROUP(PoseServer) {
  std::unique_ptr<PoseServer> server;
  void begin(bool robot) {
    server = std::make_unique<PoseServer>("0", robot);
    server->start();
  }
  void teardown() override { server.reset(); }
};

TEST(PoseServer, AFrameIsALineOfJsonWithEverythingInIt) {
  const std::string line = json_line(a_frame());
  LONGS_EQUAL(line.size() - 1, line.find('\n'));
  const auto json = nlohmann::json::parse(line);
  DOUBLES_EQUAL(1234.5, json["t"], 1e-9);
  LONGS_EQUAL(77, json["frame"].get<int>());
  DOUBLES_EQUAL(3.5, json["latency_ms"], 1e-6);
  STRCMP_EQUAL("driving", json["robot"]["state"].get<std::string>().c_str());
  DOUBLES_EQUAL(1.5, json["robot"]["yaw"], 1e-6);
  const auto& object = json["objects"][0];
  STRCMP_EQUAL("good", object["state"].get<std::string>().c_str());
  DOUBLES_EQUAL(0.5, object["yaw"], 1e-4);
  LONGS_EQUAL(21, object["covariance"].size());
  DOUBLES_EQUAL(4e-6, object["covariance"][0], 1e-12);
  CHECK_FALSE(json["objects"][1].contains("x"));  // lost: it has no pose
}

TEST(PoseServer, EveryClientGetsEveryFrameInOrder) {
  begin(false);
  Client a(server->port()), b(server->port());
  CHECK(a.connected() && b.connected());
  // Both are accepted once both are answered.
  a.say("drive 0 0\n");
  b.say("drive 0 0\n");
  CHECK(a.line().find("error") != std::string::npos && b.line().find("error") != std::string::npos);
  ServedFrame frame = a_frame();
  for (std::uint64_t i = 0; i < 10; ++i) {
    frame.report.index = i;
    server->offer(frame);
  }
  for (int i = 0; i < 10; ++i)
    for (Client* client : {&a, &b}) LONGS_EQUAL(i, nlohmann::json::parse(client->line())["frame"].get<int>());
}

TEST(PoseServer, TheFirstToDriveSteersUntilItGoesAndItsEndIsAStop) {
  begin(true);
  auto first = std::make_unique<Client>(server->port());
  first->say("drive 0.2 -0.4\n");
  const ClientCommand command = taken(*server);
  CHECK(command.monotonic_ns > 0);
  DOUBLES_EQUAL(0.2, command.v_mps, 1e-7);
  DOUBLES_EQUAL(-0.4, command.w_rps, 1e-7);
  Client second(server->port());
  second.say("drive 0.1 0\n");
  CHECK(second.line().find("another client steers") != std::string::npos);
  first.reset();
  const ClientCommand end = taken(*server, command.monotonic_ns);
  CHECK(end.monotonic_ns > command.monotonic_ns);
  DOUBLES_EQUAL(0, end.v_mps, 0);
  DOUBLES_EQUAL(0, end.w_rps, 0);
  second.say("drive 0.1 0\n");
  DOUBLES_EQUAL(0.1, taken(*server, end.monotonic_ns).v_mps, 1e-7);
}

// Far more commands than frames, and in the end a stop, or the end itself; then somebody else goes on at
// once.
TEST(PoseServer, AStopIsNeverLost) {
  begin(true);
  for (const bool by_going : {false, true}) {
    auto client = std::make_unique<Client>(server->port());
    for (int i = 0; i < 1000; ++i) client->say("drive 0.3 0\n");
    if (!by_going) client->say("stop\ndrive 0.2 0\n");
    client->say("?\n");
    CHECK(client->line().find("not understood") != std::string::npos);  // all before it was taken
    if (!by_going) {
      CHECK(server->command().take().stops());
      DOUBLES_EQUAL(0.2, server->command().take().v_mps, 1e-7);
    }
    client.reset();
    for (std::string answer = "another client"; answer.find("another client") != std::string::npos;) {
      client = std::make_unique<Client>(server->port());
      client->say("drive 0.1 0\n?\n");
      answer = client->line();
    }
    CHECK(server->command().take().stops());
    DOUBLES_EQUAL(0.1, server->command().take().v_mps, 1e-7);
  }
}

TEST(PoseServer, WhatIsNotUnderstoodIsSaidAndObeyedByNobody) {
  begin(true);
  Client client(server->port());
  client.say("drive 0 0\n");
  const ClientCommand first = taken(*server);
  for (const char* line : {"go\n", "drive\n", "drive 0.1\n", "drive 0.1 nan\n", "drive 0.1 0.2 0.3\n", "\n",
                           "drive 0.6 0\n", "drive 0 9\n", "stop now\n", "drive 1e999 0\n"}) {
    client.say(line);
    CHECK(client.line().find("\"error\"") != std::string::npos);
  }
  client.say(std::string(100000, 'x') + "\n");
  CHECK(client.line().find("\"error\"") != std::string::npos);
  client.say("dri");
  client.say("ve 0.3 0.1\r\n");
  const ClientCommand last = taken(*server, first.monotonic_ns);
  DOUBLES_EQUAL(0.3, last.v_mps, 1e-7);
  DOUBLES_EQUAL(0.1, last.w_rps, 1e-7);
}

// What a web page lets a browser post to this computer's own ports.
TEST(PoseServer, ABrowserDrivesNoRobot) {
  begin(true);
  Client browser(server->port());
  browser.say("POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\ndrive 0.3 0\r\n");
  CHECK(browser.line().find("not understood") != std::string::npos);
  STRCMP_EQUAL("", browser.line().c_str());  // closed
  CHECK(server->command().take().monotonic_ns == 0);
  Client student(server->port());  // a student's first line may ask for too much
  student.say("drive 0.9 0\n");
  CHECK(student.line().find("too fast") != std::string::npos);
  student.say("drive 0.2 0\n");
  DOUBLES_EQUAL(0.2, taken(*server).v_mps, 1e-7);
}

TEST(PoseServer, WhatAClientDoesNotReadIsNotKeptForIt) {
  begin(true);
  Client lazy(server->port());
  lazy.say("stop\n");
  constexpr int kWrong = 400000;
  for (int i = 0; i < kWrong; i += 1000) {
    std::string wrong;
    for (int k = 0; k < 1000; ++k) wrong += "?\n";
    lazy.say(wrong);
  }
  int answers = 0;
  while (!lazy.line().empty()) ++answers;
  CHECK(answers > 0 && answers < kWrong);
}

TEST(PoseServer, AClientThatDoesNotReadDelaysNobody) {
  begin(false);
  Client lazy(server->port()), keen(server->port());
  keen.say("stop\n");
  keen.line();
  ServedFrame frame = a_frame();
  for (std::uint64_t i = 0; i < 20000; ++i) {  // far more than a socket holds
    frame.report.index = i;
    server->offer(frame);
    if (i % 16 == 0)
      LONGS_EQUAL(i, nlohmann::json::parse(keen.line())["frame"].get<std::uint64_t>());
    else
      keen.line();
  }
  // What the lazy one finds are whole lines.
  for (int i = 0; i < 50; ++i) CHECK(nlohmann::json::parse(lazy.line()).contains("t"));
}
