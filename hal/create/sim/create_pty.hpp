// The simulated Create on a pseudo-terminal, in real time: what `startrack create-sim` runs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hal/create/sim/create_engine.hpp"
#include "hal/create/sim/world_script.hpp"
#include "hal/create/sim_state.hpp"

namespace st::sim {

struct CreatePtyOptions {
  CreateOptions robot;
  std::string link_path;   // symbolic link to the pseudo-terminal; empty: none
  std::string state_path;  // file of a SimStateRing; empty: none
  std::vector<WorldEvent> events;
};

class CreatePty {
 public:
  // Throws Failure when there is no pseudo-terminal, or the link or state file cannot be made.
  explicit CreatePty(const CreatePtyOptions& options);
  ~CreatePty();  // removes the link, if it is still this robot's
  CreatePty(const CreatePty&) = delete;
  CreatePty& operator=(const CreatePty&) = delete;

  const std::string& path() const { return path_; }  // of the end that a driver opens
  const CreateEngine& engine() const { return engine_; }

  // What happens to the robot, or to its cable: see WorldEventKind.
  void apply(WorldEventKind kind);
  bool pulled() const { return master_ < 0; }

  // Lives until `ended` says so; asked about once a millisecond.
  void run(const std::function<bool(double t_s)>& ended);

 private:
  void open_pair();
  void close_pair();
  void make_link();
  void remove_link();
  SimStateEntry state(std::int64_t now_ns) const;
  void exchange_bytes();

  CreatePtyOptions options_;
  CreateEngine engine_;
  std::string path_;
  int master_ = -1, slave_ = -1;
};

}  // namespace st::sim
