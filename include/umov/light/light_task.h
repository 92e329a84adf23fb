#pragma once
#include <umov/core/stop.h>

namespace umov {

/// How a batch of poses is lit: which optional columns of the table are filled, on how many
/// threads, and when to stop.
struct LightTask {
  bool has_glints = false;    ///< StokesTable::glint_share
  bool has_materials = false; ///< StokesTable::material_i
  unsigned threads = 0;       ///< the bytes do not depend on it
  const std::atomic<bool> *cancel = nullptr;
};

} // namespace umov
