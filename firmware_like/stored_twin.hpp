// The stored model that a whole volume is, compared at leisure after the loop.
#pragma once

#include <span>

#include "algo/recognition/recognition.hpp"

namespace st {

struct StoredTwin {
  int model = -1;  // -1: none
  bool has_heading = false;
  Pose T_model_volume;  // where it has
};

// Where two stored ones are as like, it is one of them. The volume must look like the model from all round:
// both are rendered as cameras about it would see them. On the heap.
StoredTwin find_twin(std::span<const KnownModel> models, const Volume& volume);

}  // namespace st
