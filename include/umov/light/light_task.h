#pragma once
#include <atomic>

namespace umov {

/// Which optional columns of the table are filled, and with what.
struct LightTask {
  bool has_glints = false;    ///< StokesTable::glint_share
  bool has_materials = false; ///< StokesTable::material_i
  unsigned threads = 0;       ///< the bytes do not depend on it
  const std::atomic<bool> *cancel = nullptr;
};

} // namespace umov
