#include "hal/create/listener.hpp"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hal/create/port_address.hpp"
#include "hal/error.hpp"

namespace st {

int listen_at(const std::string& option, const std::string& address) {
  const std::string where = address.find(':') == std::string::npos ? "127.0.0.1:" + address : address;
  const std::size_t colon = where.rfind(':');
  const std::string host = where.substr(0, colon), port = where.substr(colon + 1);
  if (host.empty() || port.empty() || port.find_first_not_of("0123456789") != std::string::npos)
    throw Failure(ExitCode::kBadInput, option + " " + address + ": is not [HOST:]PORT, such as 7171");
  PortAddress resolved;
  if (const char* error = resolve(host, port, resolved); error != nullptr)
    throw Failure(ExitCode::kBadInput,
                  option + " " + address + ": " + error + "; name this computer as others know it");
  const int fd = socket(resolved.host.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int yes = 1;
  if (fd >= 0 && setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
      bind(fd, reinterpret_cast<const sockaddr*>(&resolved.host), resolved.host_size) == 0 &&
      listen(fd, 4) == 0)
    return fd;
  const int error = errno;
  if (fd >= 0) close(fd);
  throw Failure(ExitCode::kBadInput,
                option + " " + address + ": " + std::strerror(error) + "; name another address or port");
}

int bound_port(int listener) {
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  getsockname(listener, reinterpret_cast<sockaddr*>(&bound), &size);
  const bool six = bound.ss_family == AF_INET6;
  return ntohs(six ? reinterpret_cast<const sockaddr_in6&>(bound).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(bound).sin_port);
}

}  // namespace st
