// Where other programs reach this one by TCP.
#pragma once

#include <string>

namespace st {

// `[HOST:]PORT`, this computer only without HOST. A listening, non-blocking descriptor. `option`: what the
// user wrote it after, for messages. Throws Failure (kBadInput).
int listen_at(const std::string& option, const std::string& address);
// The port that it got, also when 0 was asked for.
int bound_port(int listener);

}  // namespace st
