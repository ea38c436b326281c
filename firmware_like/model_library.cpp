#include "firmware_like/model_library.hpp"

#include <algorithm>
#include <cstdio>

namespace st {
namespace {

// The longest side of the box of bricks that hold something: they must fit about the middle.
bool fits(const PackedVolume& volume, int side) {
  const int shift = (side - volume.side) / 2 / kBrickSide, most = side / kBrickSide;
  return std::all_of(volume.bricks.begin(), volume.bricks.end(), [&](const PackedBrick& b) {
    const int places[3] = {b.x + shift, b.y + shift, b.z + shift};
    return std::all_of(std::begin(places), std::end(places), [&](int p) { return p >= 0 && p < most; });
  });
}

template <typename T>
std::span<const T> moved(const std::vector<T>& from, Bump& memory) {
  const std::span<T> to = memory.take<T>(from.size());
  if (!to.empty()) std::copy(from.begin(), from.end(), to.begin());
  return to;
}

}  // namespace

void ModelLibrary::read(ModelStore& store, int volume_side) {
  for (const ModelEntry& entry : store.list()) {
    if (entries_.size() == kMaxKnownModels) {
      std::fprintf(stderr, "startrack: warning: %s: only the first %zu models are used; delete some\n",
                   store.path().c_str(), kMaxKnownModels);
      return;
    }
    const auto stored = store.find(entry.id);
    if (!stored) continue;  // another program has just deleted it
    OwnedModel model = decode_model(stored->content, entry.name);
    if (!fits(model.volume, volume_side)) {
      std::fprintf(stderr, "startrack: warning: model %s needs --volume %d; left out\n", entry.name.c_str(),
                   model.volume.side);
      continue;
    }
    entries_.push_back(stored->entry);
    read_.push_back(std::move(model));
  }
}

void ModelLibrary::bind(Bump& memory) {
  known_.clear();
  for (const OwnedModel& model : read_) {
    KnownModel known = model.view();
    known.volume.bricks = moved(model.bricks, memory);
    known.features = {moved(model.features, memory), moved(model.descriptors, memory)};
    known_.push_back(known);
  }
  if (!memory.measuring() && !memory.overflowed()) read_.clear();
}

}  // namespace st
