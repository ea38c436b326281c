// Where a robot's bytes come and go: a serial device, or a TCP connection to a guard at the robot's end.
// Opening one takes system calls only, so that the guard can do it again after a fork.
#pragma once

#include <sys/socket.h>

#include <string>

namespace st {

struct PortAddress {
  std::string text;  // as the user gave it; for messages
  bool tcp = false;
  char device[256]{};
  int baud = 115200;
  sockaddr_storage host{};
  socklen_t host_size = 0;
};

// A device's path, or `tcp:HOST:PORT`. Throws Failure (kBadInput, or kDeviceFault when HOST is not known).
PortAddress port_address(const std::string& text, int baud);

// Looks HOST (also [IPv6]) and PORT up. Null, or why not.
const char* resolve(std::string host, const std::string& service, PortAddress& address);

// Opens it: non-blocking, raw, claimed alone. The descriptor, or minus the error. A connection is waited for
// at most so long. Only system calls.
int open_port(const PortAddress& address, int connect_ms);

// Raw 8N1 at this speed, every byte as it is. 0, or the error. Only system calls.
int set_line(int fd, int baud);

}  // namespace st
