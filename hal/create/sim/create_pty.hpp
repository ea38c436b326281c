// The simulated Create on a pseudo-terminal, in real time: what `startrack create-sim` runs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hal/create/sim/create_engine.hpp"
#include "hal/create/sim/world_script.hpp"

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

  // Lives until `ended` says so; asked about once a millisecond.
  void run(const std::function<bool(double t_s)>& ended);

 private:
  void make_link();
  void exchange_bytes();

  CreatePtyOptions options_;
  CreateEngine engine_;
  std::string path_;
  int master_ = -1, slave_ = -1;
};

}  // namespace st::sim
