#pragma once
// The fast path: a scene prepared once, then hundreds of thousands of poses per second and core.
// docs/theory/engine.md

#include <filesystem>
#include <memory>
#include <span>
#include <umov/light/abundances.h>
#include <umov/light/device.h>
#include <umov/light/light_task.h>
#include <umov/light/stokes_table.h>
#include <umov/scene/pose.h>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// How hiding is decided.
enum class Visibility {
  None, ///< nothing hides anything: right for a proven convex mesh only
  Masks ///< looked up between directions for which rays were traced beforehand
};

/// How finely masks sample the surface and the directions.
struct MaskQuality {
  std::size_t points = 0;       ///< over the whole surface, shared out by area
  std::size_t narrow_cells = 0; ///< directions: (cells + 1)^2 for small classes, even
  std::size_t wide_cells = 0;   ///< the same for large flat ones, even
  /// Poses whose half-width of I is larger than this part of I (or of EngineOptions::floor_i) are
  /// mended by rays, class by class, the most uncertain first; 0: never.
  double refine_above = 0;
};
/// Typical error of I 0.2-0.5 %, a few seconds and tens of megabytes.
inline constexpr MaskQuality fast_masks{60'000, 64, 64, 0.03};
/// For tables of many poses, where finer masks gain more than rays do (docs/theory/engine.md).
inline constexpr MaskQuality table_masks{62'000, 70, 70, 0.03};
/// Typical error of I 0.1 %, up to half a minute and 300 MB.
inline constexpr MaskQuality fine_masks{240'000, 96, 128, 0.01};

/// Typical error of I 1 %, with normals joined too: for who looks for attitudes
/// (`LightOptions::is_for_search`).
inline constexpr MaskQuality coarse_masks{16'000, 32, 32, 0};

/// The masks for a wanted typical error of I; nothing is mended by rays.
MaskQuality masks_for(double accuracy);

/// How a fast engine is prepared.
struct EngineOptions {
  Visibility visibility = Visibility::Masks; ///< a proven convex mesh takes None by itself
  MaskQuality masks = fast_masks;
  /// Per band [m2/sr]: below it I need not be known any better than at it; empty: 0.
  std::vector<double> floor_i = {};
  /// With `refine_above` > 0: half-widths count every facet that could be seen, also where the
  /// masks know of none; each pose costs tens of microseconds more.
  bool doubts_all = false;
  /// With `refine_above` > 0: rays are spent as poses far apart need them, sparingly, and what all
  /// points of the masks agree on counts as certain.
  bool is_for_many_poses = false;
  /// Part of `refine_above` that is asked of Q/I, where classes are traced.
  double q_part = 0.06;
  /// Facets of one material whose normals differ by less are joined [rad]; the error goes into the
  /// half-widths, if `tells_cluster_error`. 0: only those that are equal to 1e-5.
  double cluster_rad = 0;
  /// And by no more than that part of the slope of their narrowest lobe; 0: whatever the lobe.
  double cluster_of_lobe = 0;
  bool tells_cluster_error = true; ///< false: half-widths are as if normals were alike; quicker
  bool is_double = false; ///< the scalar reference in double instead of the vector unit in float
  bool is_intensity_only = false; ///< leaves Q = 0: to measure what polarization costs
  /// Rows of the masks are traced when a pose first asks for their direction, not all at once
  /// before: a short series asks for few.
  bool is_lazy = false;
  /// Folder of masks of earlier jobs; empty: none are kept. See Engine::keep_masks.
  std::filesystem::path mask_cache = {};
  /// Other materials on the same mesh that abundances must serve exactly too.
  std::vector<Scene> hypotheses = {};
  unsigned threads = 0; ///< of the preparation; 0: all cores
};

/// What was prepared.
struct EngineFacts {
  std::size_t triangles = 0, classes = 0, groups = 0; ///< groups of 16 classes
  std::size_t general_classes = 0; ///< lit one by one: their surface has no kernel
  std::size_t mask_bytes = 0, scene_bytes = 0;
  double setup_s = 0;
  bool is_convex = false;
};

/// A scene ready for sunlight from any direction. Evaluation is thread safe, and gives the same
/// bits for any number of threads and any split of the poses.
class Engine {
public:
  /// Compiles a scene and traces its masks. Throws Failure: Interrupted if `cancel` became true,
  /// Device where the ray tree cannot be built.
  Engine(const Scene &scene, const EngineOptions &options,
         const std::atomic<bool> *cancel = nullptr);
  /// The same with masks that `save_masks` has written for this very mesh, material groups and
  /// quality. BadInput if the file is none, is damaged or was made for something else.
  static Result<Engine> with_masks(const std::filesystem::path &file, const Scene &scene,
                                   const EngineOptions &options,
                                   const std::atomic<bool> *cancel = nullptr);
  /// Writes the masks, whole or not at all (nothing for a convex mesh: Usage). Device if it fails.
  [[nodiscard]] Result<void> save_masks(const std::filesystem::path &file) const;
  /// Puts what was traced into EngineOptions::mask_cache, if that has grown. In silence: whatever
  /// goes wrong, the masks are made anew.
  void keep_masks() const;
  /// Copies from now on what another engine has traced of the same masks, in place of tracing it
  /// again; nothing changes where its masks are others. Never both ways, or around.
  void take_masks_of(const Engine &elder) const;
  /// Bytes of the masks as they are now.
  [[nodiscard]] std::size_t mask_bytes() const;
  /// Rows were traced since the masks were read.
  [[nodiscard]] bool has_new_masks() const;
  ~Engine();
  Engine(Engine &&) noexcept;
  Engine &operator=(Engine &&) noexcept;

  /// From here on cards add up the facets of every pose (throwing Failure if one is lost); what
  /// comes after, rays and surfaces without a kernel stay with the processor. Device if the scene
  /// does not fit on them, Usage for the reference in double. `may_leave`: where masks, which grow
  /// as they are asked for, or batches no longer fit, the processor takes over for good.
  Result<void> use_cards(const std::shared_ptr<const Cards> &cards, bool may_leave = false);
  /// Why the processor has taken over from the cards; empty: it has not.
  [[nodiscard]] std::string why_cards_were_left() const;
  /// Who has lit so far, as bytes depend on it: the `identity_of` cards, with " and the processor"
  /// where that has lit poses instead of them; empty: the processor alone.
  [[nodiscard]] std::string lit_by() const;

  /// Stokes of every pose. `out` is resized.
  void evaluate(std::span<const Pose> poses, StokesTable &out, unsigned threads = 1) const;
  /// The same with the columns that `task` asks for; material_i counts the surfaces of the scene,
  /// fronts then backs, by `material_of` (2 * groups). False if it was cancelled.
  [[nodiscard]] bool evaluate(std::span<const Pose> poses, StokesTable &out, const LightTask &task,
                              std::span<const std::uint32_t> material_of = {}) const;

  /// Sums of every pose before any colour. BadInput if a material has none (measured or
  /// anisotropic surfaces: they are lit facet by facet); Interrupted if `cancel` became true.
  Result<void> abundances(std::span<const Pose> poses, AbundanceTable &out, unsigned threads = 1,
                          const std::atomic<bool> *cancel = nullptr) const;
  /// What other materials and bands (of a scene with the same mesh groups) make of this engine's
  /// sums. Their roughness and shadowing must be those of the engine's own or of its hypotheses;
  /// BadInput says which is not. Body light of others is expressed in the profiles that there are:
  /// see MaterialTables::diffuse_error.
  [[nodiscard]] Result<MaterialTables> tables_for(const Scene &materials) const;

  /// What was prepared.
  [[nodiscard]] const EngineFacts &facts() const;
  /// Bands of the scene.
  [[nodiscard]] std::size_t band_count() const;

private:
  friend class ArticulatedEngine;
  struct State;
  explicit Engine(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

} // namespace umov
