// `run --serve`: what the tracker sees, as a JSON line per frame, for programs in any language; and what the
// program that steers by it asks the robot to do. Compute thread and server meet in a ring of frames and in
// the newest command; all text, all sockets and all memory for them are the server thread's.
//
// To the client: one object per line, see hal/serve/served_frame.hpp. From the client: `drive V W` (m/s,
// rad/s, left positive) and `stop`, a line each. The first client that sends either steers until it goes; it
// has to say `drive` again at least every half second (kClientPatience_s). Its end stops the robot. A client
// whose first line is neither is no client: its connection is closed.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "hal/create/spsc_ring.hpp"
#include "hal/serve/client_command.hpp"
#include "hal/serve/served_frame.hpp"

namespace st {

class PoseServer {
 public:
  // [HOST:]PORT, loopback without HOST; port 0 takes a free one. `takes_commands`: a robot is there for
  // clients to drive. Throws Failure (kBadInput) when nothing can listen there.
  PoseServer(const std::string& address, bool takes_commands);
  ~PoseServer();
  PoseServer(const PoseServer&) = delete;
  PoseServer& operator=(const PoseServer&) = delete;

  int port() const;
  void start();
  void stop();  // safe to call twice

  // Compute thread: hands a frame on. No heap, no lock, no wait; a full ring drops the frame.
  void offer(const ServedFrame& frame);
  // For the compute thread to read.
  NewestCommand& command() { return command_; }

 private:
  struct Client {
    int fd = -1;
    bool understood = false;  // a line of it was
    std::string in, out;
  };
  void run();
  void accept_client();
  void send_frames();
  bool serve(Client& client, short events);
  bool take_line(Client& client, std::string_view line);
  void drop(Client& client);

  bool takes_commands_;
  int listener_ = -1, wake_ = -1;
  SpscRing<ServedFrame, 32> frames_;
  NewestCommand command_;
  std::vector<Client> clients_;
  int driver_ = -1;  // descriptor of the client that steers
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace st
