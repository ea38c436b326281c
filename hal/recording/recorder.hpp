// Writes a fakenect folder that the stock library replays: INDEX.txt, one file per frame, camera.toml,
// frames.csv. Files are written on a thread of its own; the caller only copies.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "algo/core/calibration.hpp"
#include "algo/core/records.hpp"
#include "hal/source/semaphore.hpp"

namespace st {

struct RecorderOptions {
  std::string folder;       // made when missing; must be empty but for a robot.log
  Calibration calibration;  // must be a Kinect's: 11-bit depth
  unsigned queue_frames = 16;
};

// The folder of a recording to come: made, and empty. For what writes into it before the recorder is there
// (robot.log). Throws Failure (kBadInput).
void make_recording_folder(const std::string& folder);

class Recorder {
 public:
  // Throws Failure (kBadInput) when the folder cannot be used or the calibration is not a Kinect's.
  explicit Recorder(const RecorderOptions& options);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Takes a copy of the depth frame, of its colour when that is new, and of gravity; a row of frames.csv
  // tells what was used: `level` of degradation, and the bytes of robot.log that had been taken in by then.
  // No heap, no lock, no wait: false, and counted, when the disk does not keep up. One caller's thread.
  bool add(const FrameInput& frame, int level, std::uint64_t robot_log_offset);

  // For sources that can wait: true once add() would find room. The same caller's thread.
  bool wait_for_room(int timeout_ms);

  // Writes what is queued, ends the thread. Safe to call twice.
  void close();

  std::uint64_t written() const { return written_.load(); }
  std::uint64_t dropped() const { return dropped_; }
  // A line for people once writing failed (disk full, ...); empty before. Nothing is written from then on.
  std::string failure() const { return failed_.load(std::memory_order_acquire) ? failure_ : std::string(); }

 private:
  struct Item {
    double t_s = 0, color_t_s = 0;
    std::uint32_t ticks = 0, color_ticks = 0;
    bool has_color = false, color_is_new = false, has_gravity = false;
    Vec3 up_mps2{};
    int level = 0;
    std::uint64_t robot_log_offset = 0;
    std::vector<std::uint16_t> depth;
    std::vector<std::uint8_t> color;
  };

  void write_all();
  void write_item(const Item& item);
  // The file first, then its line in INDEX.txt: whatever ends the process, what is listed is whole.
  void write_frame(char type, double t_s, std::uint32_t ticks, const std::string& header, const void* data,
                   std::size_t bytes);
  void write_whole(const std::string& name, const std::string& header, const void* data, std::size_t bytes);
  void append_line(int file, const std::string& line);
  void fail(const std::string& name, int error_number);

  std::string folder_;
  Calibration calibration_;
  std::vector<Item> items_;
  Semaphore filled_{0}, free_;
  std::atomic<std::uint64_t> added_{0};
  std::uint64_t dropped_ = 0;             // caller's
  std::uint32_t color_ticks_queued_ = 0;  // caller's: of the newest colour that was queued
  bool color_queued_ = false;             // caller's
  std::atomic<std::uint64_t> written_{0};
  std::atomic<bool> closing_{false}, failed_{false};
  std::string failure_;
  double last_t_s_ = 0;               // of the newest line of INDEX.txt
  int index_ = -1, frames_csv_ = -1;  // files, appended line by line
  std::thread thread_;
};

}  // namespace st
