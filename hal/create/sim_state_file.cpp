#include "hal/create/sim_state_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>

#include "hal/error.hpp"

namespace st {

SimStateWriter::SimStateWriter(const std::string& path) {
  const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  void* memory = MAP_FAILED;
  if (fd >= 0 && ftruncate(fd, 0) == 0 && ftruncate(fd, sizeof(SimStateRing)) == 0)
    memory = mmap(nullptr, sizeof(SimStateRing), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  const int error = errno;
  if (fd >= 0) close(fd);
  if (memory == MAP_FAILED)
    throw Failure(ExitCode::kBadInput,
                  "state file " + path + ": " + std::strerror(error) + "; name another with --state");
  ring_ = new (memory) SimStateRing;
}

SimStateWriter::~SimStateWriter() { munmap(ring_, sizeof(SimStateRing)); }

void SimStateWriter::publish(const SimStateEntry& entry) {
  const std::uint64_t index = ring_->written.load(std::memory_order_relaxed);
  ring_->entries[index % SimStateRing::kEntries] = entry;
  ring_->written.store(index + 1, std::memory_order_release);
}

SimStateReader::SimStateReader(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  void* memory = MAP_FAILED;
  if (fd >= 0 && lseek(fd, 0, SEEK_END) >= static_cast<off_t>(sizeof(SimStateRing)))
    memory = mmap(nullptr, sizeof(SimStateRing), PROT_READ, MAP_SHARED, fd, 0);
  if (fd >= 0) close(fd);
  if (memory != MAP_FAILED) ring_ = static_cast<const SimStateRing*>(memory);
  if (ring_ == nullptr || ring_->magic != SimStateRing::kMagic || ring_->version != SimStateRing::kVersion) {
    if (ring_ != nullptr) munmap(memory, sizeof(SimStateRing));
    throw Failure(ExitCode::kDeviceFault,
                  "state file " + path +
                      ": no simulated robot writes it; start `startrack create-sim --state FILE` first");
  }
}

SimStateReader::~SimStateReader() { munmap(const_cast<SimStateRing*>(ring_), sizeof(SimStateRing)); }

std::uint64_t SimStateReader::written() const { return ring_->written.load(std::memory_order_acquire); }

bool SimStateReader::entry(std::uint64_t index, SimStateEntry& out) const {
  if (index >= written()) return false;
  out = ring_->entries[index % SimStateRing::kEntries];
  std::atomic_thread_fence(std::memory_order_acquire);
  // Not overwritten while it was copied: the writer is then still less than a round ahead.
  return ring_->written.load(std::memory_order_relaxed) < index + SimStateRing::kEntries;
}

bool SimStateReader::newest(SimStateEntry& out) const {
  const std::uint64_t count = written();
  return count > 0 && entry(count - 1, out);
}

}  // namespace st
