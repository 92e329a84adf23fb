#pragma once
#include <atomic>

namespace umov {

/// Somebody wants the work to end. nullptr: nobody can.
inline bool is_stopped(const std::atomic<bool> *cancel) { return cancel != nullptr && *cancel; }

/// How a batch of poses is lit: which optional columns of the table are filled, on how many
/// threads, and when to stop.
struct LightTask {
  bool has_glints = false;    ///< StokesTable::glint_share
  bool has_materials = false; ///< StokesTable::material_i
  unsigned threads = 0;       ///< the bytes do not depend on it
  const std::atomic<bool> *cancel = nullptr;
};

} // namespace umov
