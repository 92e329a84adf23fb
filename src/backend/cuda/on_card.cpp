#include "backend/cuda/on_card.h"

#include <algorithm>
#include <type_traits>

namespace umov::backend {
namespace {

template <class T> std::size_t bytes_of(View<T> view) { return view.size() * sizeof(T); }

std::size_t bytes_of(const SceneData<float> &scene) {
  return bytes_of(scene.groups) + 4 * bytes_of(scene.cones.x) + bytes_of(scene.chunks) +
         bytes_of(scene.slots) + bytes_of(scene.lobes) + bytes_of(scene.families) +
         bytes_of(scene.profiles) + bytes_of(scene.products) + bytes_of(scene.cluster_error) +
         bytes_of(scene.patches) + bytes_of(scene.patches_of) +
         3 * bytes_of(scene.patch_nodes.weight);
}

std::size_t bytes_of(const Masks &masks) {
  return bytes_of(masks.small.offset) + bytes_of(masks.large.offset) + bytes_of(masks.groups) +
         bytes_of(masks.pool);
}

/// Chunks as short as a thread's lists.
std::vector<Chunk> short_chunks(View<const Chunk> chunks) {
  std::vector<Chunk> out;
  for (const Chunk &chunk : chunks)
    for (std::uint32_t done = 0; done < chunk.count; done += groups_per_thread)
      out.push_back({chunk.first + done,
                     std::min(static_cast<std::uint32_t>(groups_per_thread), chunk.count - done),
                     chunk.slot});
  return out;
}

} // namespace

template <class T> Result<View<T>> CardLoops::OnCard::put(View<T> from, Pieces &pieces) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (from.empty())
    return View<T>();
  UMOV_ASSIGN(memory, card_.allocate(bytes_of(from), is_full_));
  const CudaDriver &driver = card_.driver();
  CudaCode code = driver.copy_in(memory.pointer(), from.data(), bytes_of(from));
  // From memory that is not pinned the copy may still be under way (CUDA's "API synchronization
  // behavior"), and the streams of batches do not wait for the default one.
  if (code == cuda_success)
    code = driver.wait_for(nullptr);
  UMOV_TRY(driver.check(code, "copying to " + card_.facts().name));
  View<T> out(memory.template as<T>(), from.size());
  pieces.push_back(std::move(memory));
  return out;
}

Result<void> CardLoops::OnCard::check_room(const char *what, std::size_t bytes) {
  UMOV_ASSIGN(free, card_.free_bytes());
  is_full_ = bytes > free;
  if (!is_full_)
    return {};
  return fail(ErrorCode::Device, std::string(what) + " take " + std::to_string(bytes) +
                                     " bytes and " + card_.facts().name + " has " +
                                     std::to_string(free) +
                                     " left: take --device cpu, a card with more memory, or a "
                                     "coarser accuracy (fewer points and directions)");
}

Result<std::unique_ptr<CardLoops::OnCard>> CardLoops::OnCard::make(const Card &card,
                                                                   const CardSource &source) {
  std::unique_ptr<OnCard> out(new OnCard(card));
  UMOV_TRY(card.use());
  UMOV_TRY(out->check_room("the facets of the scene", bytes_of(source.scene)));
  const SceneData<float> &from = source.scene;
  SceneData<float> &to = out->scene_.scene;
  Pieces &pieces = out->scene_pieces_;
  const std::vector<Chunk> chunks = short_chunks(from.chunks);
  Result<void> failed;
  const auto put = [&]<class T>(View<T> host, View<T> &there) {
    if (!failed)
      return;
    auto copied = out->put(host, pieces);
    if (copied)
      there = *copied;
    else
      failed = tl::unexpected(copied.error());
  };
  put(from.groups, to.groups);
  put(from.cones.x, to.cones.x);
  put(from.cones.y, to.cones.y);
  put(from.cones.z, to.cones.z);
  put(from.cones.least, to.cones.least);
  put(View<const Chunk>(chunks), to.chunks);
  put(from.slots, to.slots);
  put(from.lobes, to.lobes);
  put(from.families, to.families);
  put(from.profiles, to.profiles);
  put(from.products, to.products);
  put(from.cluster_error, to.cluster_error);
  put(from.patches, to.patches);
  put(from.patches_of, to.patches_of);
  put(from.patch_nodes.first, to.patch_nodes.first);
  put(from.patch_nodes.second, to.patch_nodes.second);
  put(from.patch_nodes.weight, to.patch_nodes.weight);
  put(source.lobes, out->scene_.lobes);
  UMOV_TRY(failed);
  UMOV_TRY(out->put_colours(source.colours));
  out->scene_.has_polarized_body = source.has_polarized_body;
  out->scene_.error = source.error;
  return out;
}

Result<void> CardLoops::OnCard::put_colours(const CardColourSource &from) {
  std::vector<SlotColour<float>> slots;
  slots.reserve(from.slots.size());
  for (const SlotColour<float> &slot : from.slots) {
    slots.push_back(slot);
    UMOV_ASSIGN(lobe, put(slot.lobe, scene_pieces_));
    slots.back().lobe = lobe;
    for (View<const float> SlotColour<float>::*column :
         {&SlotColour<float>::single_bounce, &SlotColour<float>::whole, &SlotColour<float>::q,
          &SlotColour<float>::u}) {
      UMOV_ASSIGN(copied, put(slot.*column, scene_pieces_));
      slots.back().*column = copied;
    }
  }
  CardColours to;
  UMOV_ASSIGN(put_slots, put(View<const SlotColour<float>>(slots), scene_pieces_));
  UMOV_ASSIGN(rounding, put(from.rounding, scene_pieces_));
  UMOV_ASSIGN(values, put(from.reflection.values, scene_pieces_));
  to.slots = put_slots;
  to.rounding = rounding;
  to.reflection = {values, from.reflection.columns, from.reflection.steps};
  to.bands = from.bands;
  scene_.colours = to;
  return {};
}

Result<void> CardLoops::OnCard::put_table(const MaskTable &from, MaskTable &to) {
  to.cells = from.cells;
  to.entries = from.entries;
  UMOV_ASSIGN(offset, put(from.offset, mask_pieces_));
  to.offset = offset;
  return {};
}

Result<void> CardLoops::OnCard::put_masks(const Masks *masks, std::size_t version) {
  if (masks == nullptr || (scene_.has_masks && version == version_))
    return {};
  UMOV_TRY(card_.use());
  scene_.has_masks = false;
  mask_pieces_.clear();
  UMOV_TRY(check_room("the masks", bytes_of(*masks)));
  Masks to;
  to.longest = masks->longest;
  UMOV_TRY(put_table(masks->small, to.small));
  UMOV_TRY(put_table(masks->large, to.large));
  UMOV_ASSIGN(groups, put(masks->groups, mask_pieces_));
  UMOV_ASSIGN(pool, put(masks->pool, mask_pieces_));
  to.groups = groups;
  to.pool = pool;
  scene_.masks = to;
  scene_.has_masks = true;
  version_ = version;
  return {};
}

} // namespace umov::backend
