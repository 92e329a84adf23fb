#include "light/fast/cards.h"
#include "light/model/models.h"
#include "light/unless_stopped.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/files.h>
#include <umov/light/instruction_set.h>
#include <umov/light/point_budget.h>

namespace umov {
namespace {

/// How hiding is decided, for the header of a file.
std::string in_words(const LightFacts &facts, const MaskQuality &masks) {
  if (facts.is_convex)
    return "none: the mesh is convex";
  const auto directions = [](std::size_t cells) { return (cells + 1) * (cells + 1); };
  std::string out = fmt::format("direction masks, {} points, {} and {} directions", masks.points,
                                directions(masks.narrow_cells), directions(masks.wide_cells));
  if (masks.refine_above > 0) {
    out += fmt::format("; rays where the half-width of I exceeds {:g} of it", masks.refine_above);
    if (!facts.floor_i.empty())
      out += fmt::format(", or, where I is less, of {:.3g} m2/sr", fmt::join(facts.floor_i, ", "));
  }
  return out;
}

} // namespace

MasksLight::MasksLight(const Scene &of, std::vector<Joint> turning, const LightOptions &options,
                       const std::vector<double> &typical_i, const Engine *unhidden,
                       const std::atomic<bool> *cancel)
    : LightModel(of, std::move(turning)), options_(options), floor_i_(floor_of(options, typical_i)),
      material_of_(material_of_slots(scene(), materials())) {
  if (unhidden != nullptr)
    curved_.emplace(scene(), *unhidden, options.threads, cancel);
}

Result<std::unique_ptr<LightModel>>
MasksLight::make(const Scene &scene, std::vector<Joint> joints, const LightOptions &options,
                 const std::vector<double> &typical_i, const Engine *unhidden,
                 std::chrono::steady_clock::time_point begin, const std::atomic<bool> *cancel,
                 ChainSharing chains) {
  std::unique_ptr<MasksLight> out(
      new MasksLight(scene, std::move(joints), options, typical_i, unhidden, cancel));
  UMOV_TRY(out->prepare(begin, cancel, std::move(chains)));
  return out;
}

Result<void> MasksLight::prepare(std::chrono::steady_clock::time_point begin,
                                 const std::atomic<bool> *cancel, ChainSharing chains) {
  const bool is_auto = options_.method == LightMethod::Auto;
  facts_.floor_i = of_bands(floor_i_);
  EngineOptions with;
  with.threads = options_.threads;
  // What masks lack, rays add: finer masks cost more to make than they save.
  with.masks = !is_auto                     ? masks_for(options_.accuracy)
               : options_.is_for_many_poses ? table_masks
                                            : fast_masks;
  if (is_auto) { // the allowance for curved elements comes on top of what sampling leaves
    const double most = options_.is_for_many_poses ? 0.95 : 0.9;
    const double left = std::clamp(0.95 - curved_->typical() / options_.accuracy, 0.4, most);
    with.masks.refine_above = left * options_.accuracy;
  }
  with.tells_cluster_error = options_.has_half_widths;
  if (options_.is_for_search && !is_auto) {
    with.masks = coarse_masks;
    with.cluster_rad = 0.1;
    with.cluster_of_lobe = 0.5;
  }
  with.doubts_all = is_auto && !options_.is_for_many_poses;
  with.is_for_many_poses = options_.is_for_many_poses;
  with.q_part = 1; // Q in parts of I, to the accuracy of I
  with.is_lazy = true;
  with.mask_cache = options_.mask_file.empty() ? options_.mask_cache : "";
  with.floor_i = floor_i_;
  if (joints().empty() && !options_.mask_file.empty() && file_exists(options_.mask_file)) {
    UMOV_ASSIGN(read, Engine::with_masks(options_.mask_file, scene(), with, cancel));
    engine_.emplace(std::move(read));
  } else if (joints().empty()) {
    engine_.emplace(scene(), with, cancel);
  } else {
    turning_.emplace(scene(), joints(), with, cancel);
  }
  facts_.method = options_.method;
  facts_.instruction_set = engine_instruction_set();
  UMOV_TRY(take_device());
  facts_.is_convex = engine_ && engine_->facts().is_convex;
  facts_.classes = engine_ ? engine_->facts().classes : 0;
  facts_.visibility = in_words(facts_, with.masks);
  IntegrationOptions rays = integration_of(options_, floor_i_);
  if (options_.bounces > 1 && !facts_.is_convex)
    between_.emplace(scene(), joints(), rays, materials(), std::move(chains));
  rays.bounces = 1;
  if (options_.max_points == 0)
    rays.max_points = most_points::beside_masks;
  if (is_auto)
    direct_.emplace(scene(), joints(), rays, materials());
  facts_.setup_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return {};
}

Result<void> MasksLight::take_device() {
  const DeviceOptions &device = options_.device;
  if (!engine_) {
    if (device.choice == DeviceChoice::Cuda)
      return fail(ErrorCode::Usage,
                  "parts that turn are lit by the processor: take --device cpu or auto");
    if (device.choice == DeviceChoice::Auto)
      facts_.device = "cpu: parts that turn are lit by the processor";
    return {};
  }
  UMOV_ASSIGN(taken, take_cards(*engine_, device));
  if (!taken.empty() && !taken.starts_with("cpu"))
    facts_.instruction_set = taken;
  facts_.device = std::move(taken);
  return {};
}

std::string MasksLight::device() const {
  return engine_ ? device_now(*engine_, facts_.device) : facts_.device;
}

std::string MasksLight::instruction_set() const {
  return engine_ ? instructions_now(*engine_, facts_.instruction_set) : facts_.instruction_set;
}

std::string MasksLight::lit_by() const { return engine_ ? engine_->lit_by() : ""; }

Result<void> MasksLight::keep_masks() const {
  if (turning_)
    turning_->keep_masks();
  else if (options_.mask_file.empty())
    engine_->keep_masks();
  else if (engine_->has_new_masks())
    return engine_->save_masks(options_.mask_file);
  return {};
}

void MasksLight::take_masks_of(const LightModel &elder) const {
  const auto *const other = dynamic_cast<const MasksLight *>(&elder);
  if (engine_ && other != nullptr && other->engine_)
    engine_->take_masks_of(*other->engine_);
}

std::size_t MasksLight::mask_bytes() const {
  return engine_ ? engine_->mask_bytes() : turning_->mask_bytes();
}

/// Poses that miss the accuracy for all that was mended. By rays one of them costs as much as a
/// thousand others are looked up in: of many poses those are left that miss it by less than half.
std::vector<std::size_t> MasksLight::inaccurate(const StokesTable &table) const {
  // 1.001: rounding of what was mended to the very accuracy
  const double slack = options_.is_for_many_poses ? 1.5 : 1.001;
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < table.poses(); ++k)
    for (std::size_t b = 0; b < table.bands; ++b) {
      const std::size_t at = k * table.bands + b;
      const double refers_to = std::max(table.i[at], floor_i_.empty() ? 0 : floor_i_[b]);
      if (table.i_err[at] > slack * options_.accuracy * refers_to) {
        out.push_back(k);
        break;
      }
    }
  return out;
}

bool MasksLight::light(std::span<const Pose> poses, std::span<const double> angles_rad,
                       StokesTable &out, const LightTask &task) const {
  const bool is_done = engine_ ? engine_->evaluate(poses, out, task, material_of_)
                               : turning_->evaluate(poses, angles_rad, out, task, material_of_);
  if (!is_done)
    return false;
  const auto add_curved = [&] {
    if (curved_)
      curved_->add_to(out, poses, task.threads, task.cancel);
    return true;
  };
  if (!unless_stopped(task.cancel, add_curved))
    return false;
  if (direct_) {
    const std::vector<std::size_t> left = inaccurate(out);
    if (!left.empty() && !direct_->light(poses, angles_rad, left, out, task))
      return false;
  }
  return !between_ || between_->add_indirect(poses, angles_rad, out, task);
}

} // namespace umov
