// The known models of a run: read from the database before the first frame, then in the arena.
#pragma once

#include <string>
#include <vector>

#include "algo/recognition/recognition.hpp"
#include "firmware_like/model_codec.hpp"

namespace st {

class ModelLibrary {
 public:
  // Reads every model. What does not fit a volume of `volume_side` voxels a side is left out, with a warning
  // on stderr. Throws Failure (kBadInput).
  void read(ModelStore& store, int volume_side);

  // Takes room for what was read; once it is real memory, the models move there.
  void bind(Bump& memory);

  std::span<const KnownModel> models() const { return known_; }
  const ModelEntry& entry(std::size_t i) const { return entries_[i]; }
  bool empty() const { return entries_.empty(); }

 private:
  std::vector<ModelEntry> entries_;
  std::vector<OwnedModel> read_;  // until bind()
  std::vector<KnownModel> known_;
};

}  // namespace st
