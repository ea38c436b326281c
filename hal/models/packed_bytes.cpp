#include "hal/models/packed_bytes.hpp"

#include <zlib.h>

#include <cstdint>
#include <cstring>

#include "hal/error.hpp"

namespace st {
namespace {

constexpr int kLevel = 4;  // beyond it saving takes twice as long for a few percent

}  // namespace

std::string compress_bytes(std::string_view content) {
  const std::uint64_t size = content.size();
  uLongf bound = compressBound(content.size());
  std::string packed(sizeof size + bound, '\0');
  std::memcpy(packed.data(), &size, sizeof size);
  const int code = compress2(reinterpret_cast<Bytef*>(packed.data() + sizeof size), &bound,
                             reinterpret_cast<const Bytef*>(content.data()), content.size(), kLevel);
  if (code != Z_OK) throw Failure(ExitCode::kBadInput, "zlib: not enough memory to store a model");
  packed.resize(sizeof size + bound);
  return packed;
}

std::string expand_bytes(std::string_view packed, std::size_t most, const std::string& name) {
  std::uint64_t size = 0;
  const Failure damaged(ExitCode::kBadInput,
                        name + ": its content is damaged; delete the model, or take a backup");
  if (packed.size() < sizeof size) throw damaged;
  std::memcpy(&size, packed.data(), sizeof size);
  if (size > most) throw damaged;
  std::string content(size, '\0');
  uLongf length = size;
  const int code =
      uncompress(reinterpret_cast<Bytef*>(content.data()), &length,
                 reinterpret_cast<const Bytef*>(packed.data() + sizeof size), packed.size() - sizeof size);
  if (code != Z_OK || length != size) throw damaged;
  return content;
}

}  // namespace st
