// Known models between the loop's form (algo/recognition/known_model.hpp) and the database's bytes. On the
// heap, before and after the loop.
#pragma once

#include <vector>

#include "algo/recognition/known_model.hpp"
#include "hal/models/model_store.hpp"

namespace st {

// A model that owns what it consists of.
struct OwnedModel {
  PackedVolume volume;  // its bricks are `bricks`
  std::vector<PackedBrick> bricks;
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;
  ModelTraits traits;

  KnownModel view() const;
};

// Little-endian, then zlib. The thumbnail is the caller's.
ModelContent encode_model(const KnownModel& model);

// Throws Failure (kBadInput) when the bytes are damaged or say something impossible. `name`: for the message.
OwnedModel decode_model(const ModelContent& content, const std::string& name);

// Describes a finished volume: packs it, finds its features and colours. Some 50 ms.
OwnedModel describe_volume(const Volume& volume, const ModelTraits& traits);

// Sizes and counts for the list; the rest is the caller's.
ModelEntry entry_of(const KnownModel& model);

}  // namespace st
