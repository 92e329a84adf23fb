// What the masks hold of one entry around a direction.
#if defined(UMOV_BACKEND_MASK_LOOK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_BACKEND_MASK_LOOK_INL_H
#undef UMOV_BACKEND_MASK_LOOK_INL_H
#else
#define UMOV_BACKEND_MASK_LOOK_INL_H
#endif

#include "backend/scene_data.h"

#include "kernel/begin.h"

/// The blocks of one entry in the three directions around one.
struct EntryLook {
  const backend::MaskBlock *block[3];
  bool is_free = false, is_hidden = false;
};

UMOV_KERNEL EntryLook look_up(const backend::Masks &masks, const backend::MaskTable &table,
                              const backend::GridLook &look, std::uint32_t entry) {
  EntryLook out;
  std::uint32_t offset[3];
  for (std::size_t k = 0; k < 3; ++k) {
    offset[k] = table.offset[look.direction[k] * table.entries + entry];
    out.block[k] = masks.pool.data() + offset[k];
  }
  out.is_free = offset[0] == masks.free() && offset[1] == masks.free() && offset[2] == masks.free();
  out.is_hidden =
      offset[0] == masks.hidden() && offset[1] == masks.hidden() && offset[2] == masks.hidden();
  return out;
}

#include "kernel/end.h"
#endif
