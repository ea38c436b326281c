#include "hal/serve/pose_server.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "hal/clock.hpp"
#include "hal/create/listener.hpp"
#include "hal/error.hpp"

namespace st {
namespace {

constexpr std::size_t kMostClients = 8, kLongestLine = 200;
constexpr std::size_t kMostUnread_bytes = 4096;  // of answers that a client does not read

}  // namespace

PoseServer::PoseServer(const std::string& address, bool takes_commands)
    : takes_commands_(takes_commands),
      listener_(listen_at("--serve", address)),
      wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (wake_ >= 0) return;
  close(listener_);
  throw Failure(ExitCode::kDeviceFault, "--serve: no file descriptor is left; close other programs");
}

PoseServer::~PoseServer() {
  stop();
  for (const Client& client : clients_) close(client.fd);
  close(listener_);
  close(wake_);
}

int PoseServer::port() const { return bound_port(listener_); }

void PoseServer::start() {
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "st-serve");
}

void PoseServer::stop() {
  stopping_.store(true);
  const std::uint64_t one = 1;
  if (write(wake_, &one, sizeof one) < 0) return;  // full: it is awake
  if (thread_.joinable()) thread_.join();
}

void PoseServer::offer(const ServedFrame& frame) {
  if (!frames_.push(frame)) return;
  const std::uint64_t one = 1;
  if (write(wake_, &one, sizeof one) < 0) return;  // full: it has enough to wake up for
}

void PoseServer::run() {
  std::vector<pollfd> events;
  while (!stopping_.load()) {
    events.assign({{wake_, POLLIN, 0}, {listener_, POLLIN, 0}});
    for (const Client& client : clients_)
      events.push_back({client.fd, static_cast<short>(client.out.empty() ? POLLIN : POLLIN | POLLOUT), 0});
    if (poll(events.data(), events.size(), -1) < 0 && errno != EINTR) return;
    std::uint64_t woken = 0;
    if (events[0].revents != 0 && read(wake_, &woken, sizeof woken) < 0) continue;
    for (std::size_t i = 0; i < clients_.size(); ++i)
      if (events[2 + i].revents != 0 && !serve(clients_[i], events[2 + i].revents)) drop(clients_[i]);
    std::erase_if(clients_, [](const Client& client) { return client.fd < 0; });
    if (events[1].revents != 0) accept_client();
    send_frames();
  }
}

void PoseServer::accept_client() {
  const int fd = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (fd < 0) return;
  if (clients_.size() >= kMostClients) {
    close(fd);
    return;
  }
  const int yes = 1;  // a frame waits for no other
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  clients_.push_back({fd, false, {}, {}});
}

// A client that is too slow for a frame misses it, whole.
void PoseServer::send_frames() {
  static thread_local ServedFrame frame;
  while (frames_.pop(frame)) {
    if (clients_.empty()) continue;
    const std::string line = json_line(frame);
    for (Client& client : clients_) {
      if (!client.out.empty()) continue;
      client.out = line;
      if (!serve(client, POLLOUT)) drop(client);
    }
    std::erase_if(clients_, [](const Client& client) { return client.fd < 0; });
  }
}

// False: it is gone.
bool PoseServer::serve(Client& client, short events) {
  if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) {
    char bytes[512];
    const ssize_t n = recv(client.fd, bytes, sizeof bytes, 0);
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) return false;
    for (ssize_t i = 0; i < n; ++i) {
      if (bytes[i] == '\n') {
        const bool speaks = take_line(client, client.in);
        client.in.clear();
        if (!speaks) {
          send(client.fd, client.out.data(), client.out.size(), MSG_NOSIGNAL);
          return false;
        }
      } else if (client.in.size() < kLongestLine) {
        client.in += bytes[i];
      }
    }
  }
  while (!client.out.empty()) {
    const ssize_t n = send(client.fd, client.out.data(), client.out.size(), MSG_NOSIGNAL);
    if (n < 0) return errno == EAGAIN || errno == EINTR;
    client.out.erase(0, static_cast<std::size_t>(n));
  }
  return true;
}

// False: its first line is none of ours. A web page can make a browser post what it likes to this computer's
// own ports, drive commands among it, but not without the browser's words before them.
bool PoseServer::take_line(Client& client, std::string_view line) {
  ClientCommand command;
  std::string error;
  client.understood = parse_client_line(line, command, error) || client.understood;
  if (error.empty() && !takes_commands_)
    error = "there is no robot to drive here; start run with --robot and without --path";
  else if (error.empty() && driver_ >= 0 && driver_ != client.fd)
    error = "another client steers; it has to close its connection first";
  if (!error.empty()) {
    if (client.out.size() < kMostUnread_bytes) client.out += "{\"error\": \"" + error + "\"}\n";
    return client.understood;
  }
  driver_ = client.fd;
  command.monotonic_ns = system_clock().monotonic_ns();
  command_.put(command);
  return true;
}

void PoseServer::drop(Client& client) {
  if (client.fd == driver_) {
    command_.put({system_clock().monotonic_ns(), 0, 0});
    driver_ = -1;
  }
  close(client.fd);
  client.fd = -1;
}

}  // namespace st
