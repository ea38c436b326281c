// Bytes for the database, compressed with zlib; zlib's own check sum tells damage.
#pragma once

#include <string>
#include <string_view>

namespace st {

// The size of the content stands before it, 8 bytes little-endian.
std::string compress_bytes(std::string_view content);

// Throws Failure (kBadInput) when the bytes are no such content, or say that they hold more than `most`.
// `name`: for the message.
std::string expand_bytes(std::string_view packed, std::size_t most, const std::string& name);

}  // namespace st
