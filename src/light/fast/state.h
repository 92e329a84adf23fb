#pragma once
// Private: what an engine holds, and how a pose goes through it.

#include "light/fast/cards.h"
#include "light/fast/compile.h"
#include "light/fast/lazy_masks.h"
#include "light/fast/mask_errors.h"
#include "light/fast/refine_points.h"

#include <array>
#include <functional>
#include <optional>
#include <umov/light/engine.h>

namespace umov {

using backend::normal_95;

/// Writes a pose's light to its row, times `scale`. Q and U are 0 without a scattering plane.
void put_light(const BandLight &light, double scale, bool has_plane, bool has_u_or_v,
               std::size_t row, StokesTable &out);
void put_darkness(std::size_t row, StokesTable &out);
/// Some band has light.
bool has_any_light(const BandLight &light);

/// What cards finish alone: called in the stead of `body` for poses that came back from them.
/// Empty: they give sums, and `body` goes on from there.
struct FromCards {
  backend::CardWants wants = backend::CardWants::Sums;
  std::function<void(std::size_t row, const backend::CardRows &rows, std::size_t row_of_card)> take;
};

struct Engine::State {
  /// Throws as Engine, here and below.
  State(const Scene &of, const EngineOptions &with, const std::atomic<bool> *cancel);
  State(const State &) = delete; // `views` point into it
  State &operator=(const State &) = delete;
  /// Masks read from a file, or made.
  void take_masks(std::optional<MaskStore> ready, const std::atomic<bool> *cancel);
  [[nodiscard]] bool has_masks() const;
  [[nodiscard]] MaskSize mask_size() const;

  Scene scene;
  EngineOptions options;
  EngineFacts facts;
  Elements elements;
  FacetClasses classes;
  GroupPlan plan;
  CompiledScene compiled;
  SceneStore<float> single;
  std::shared_ptr<LazyMasks> masks; ///< null: nothing hides anything
  /// Of `compiled` and `single`, for the loops.
  struct Views {
    backend::SceneData<double> whole;
    backend::SceneData<float> single;
  } views;
  std::optional<Occluder> occluder;
  RefinePoints refine_points;
  std::vector<std::uint32_t> judged_bands; ///< in which the errors of single facets are weighed
  /// Flat classes: where each is, and how near the half vector must be.
  struct Flat {
    Vec3<Body> normal;
    double cosine;
    std::uint32_t group, lane, slot;
  };
  std::vector<Flat> flats;              ///< by group and lane
  std::unique_ptr<CardEngine> on_cards; ///< null: the processor adds up
  [[nodiscard]] const Flat *flat_of(const backend::SeenFacet &facet) const;
  [[nodiscard]] std::vector<Flat> find_flats() const;

  /// A pose made ready; the next one is while this one is summed.
  struct Prepared {
    double cos_phase = 1;
    PoseStore<double> pose;
    PoseStore<float> single;
    /// Sums that cards have added up, of this pose in a batch of theirs; null: none.
    const backend::CardRows *card_sums = nullptr;
    std::size_t row_of_card = 0;
  };

  /// What one thread needs besides.
  struct Workspace {
    explicit Workspace(const State &of);
    std::array<Prepared, 2> prepared;
    SumsStore sums;
    std::vector<double> specular_deviation, product_deviation; ///< roots of the sums' variances
    bool varies = true; ///< some of those roots are not 0; else they are not set
    PhaseFactors factors;
    BandLight light;   ///< of the whole
    BandLight general; ///< of the facets without a kernel
    BandLight part;
    // Of `mend`:
    std::vector<double> reference; ///< per band: what relative errors refer to
    std::vector<double> q_share;   ///< per band: Q/I of the whole
    WeighedStore uncertain;
    /// Of facets without a kernel: [uncertain * bands + band], per area.
    std::vector<Stokes<ScatteringPlane>> facet_light;
    std::vector<double> unit; ///< a one among zeros
    /// Slot by slot [term * bands + band], and where each slot begins.
    std::vector<Stokes<ScatteringPlane>> unit_light;
    std::vector<std::uint32_t> unit_first;
    std::vector<double> moments; ///< of a slot's weights: with deviations, and pairs with variances
    BandLight variances;         ///< of the whole, facet by facet
    bool has_variances = false;  ///< they take the place of those of the sums
    std::vector<std::pair<double, std::uint32_t>> worst; ///< error and which, as a heap
    std::vector<double> error_per_area;  ///< per uncertain facet, in parts of the whole light
    std::vector<AskedClass> asked;       ///< classes that are looked at together
    std::vector<DoubtfulPoint> doubtful; ///< points of theirs
    std::vector<std::size_t> points;     ///< per uncertain facet: traced; 0: looked up
    std::optional<RefineTracer> tracer;
    bool is_mended = false;        ///< rays were traced for this pose
    bool is_coloured = false;      ///< `light` is that of the sums as they are now
    std::vector<double> general_i; ///< [slot * bands + band], of the facets without a kernel
    // Of `glint_share`:
    SeenStore seen;
    std::vector<backend::Chunk> near_flats; ///< their groups
  };

  [[nodiscard]] const backend::Masks *hiding() const { return masks ? &masks->view() : nullptr; }
  /// Masks for these poses, as long as what is returned is held; not all if the task is cancelled.
  [[nodiscard]] ReadLock hold_masks(std::span<const Pose> poses, const LightTask &task) const;
  [[nodiscard]] std::uint64_t key_of_masks() const;
  void keep_masks() const;
  [[nodiscard]] std::size_t bands() const { return scene.grid.nodes().size(); }
  [[nodiscard]] std::size_t terms_max() const; ///< lobes and products of a slot, at most

  void prepare(const Pose &pose, Prepared &out) const;
  [[nodiscard]] const backend::MaskErrorModel &error_model() const;
  [[nodiscard]] bool may_mend() const { return masks && options.masks.refine_above > 0; }
  /// Where the masks see nothing there may be something all the same.
  [[nodiscard]] bool doubts_darkness() const { return may_mend() && options.doubts_all; }
  /// All sums of a pose, and the light that has none; false if nothing is both lit and seen, beyond
  /// doubt.
  bool sum(const Pose &pose, const Prepared &at, Workspace &work) const;
  /// The same without rays. `has_colours`: what reflection depends on is made ready too.
  bool add_up(const Pose &pose, const Prepared &at, Workspace &work, bool has_colours = true) const;
  /// work.light from the sums.
  void colour(Workspace &work) const;
  /// The same, with I of each slot's material added to intensity[material * bands + band].
  void colour_by_material(std::span<const std::uint32_t> material, double *intensity,
                          Workspace &work) const;
  /// Part of I in band 0 that flats reflect whose normal is within their lobe's half width of the
  /// half vector.
  double glint_share(const Pose &pose, const Prepared &at, Workspace &work) const;
  /// Runs `body(row, pose, prepared, workspace)` for all poses, in an order that suits the masks;
  /// for none any more once the task is cancelled.
  template <class Body>
  void for_each(std::span<const Pose> poses, const LightTask &task, const Body &body,
                const FromCards &from_cards = {}) const;

  /// The same with the sums of cards, batch by batch; how many of `order` are done. Fewer than all
  /// where memory no longer suffices and the processor may take over. Throws Failure if a card is
  /// lost.
  template <class Body>
  std::size_t for_each_on_cards(std::span<const Pose> poses, std::span<const std::uint32_t> order,
                                const LightTask &task, const Body &body,
                                const FromCards &from_cards) const;

  [[nodiscard]] bool needs_pose_beside_cards(const LightTask &task) const;
  void take_light(const backend::CardRows &rows, std::size_t row_of_card, std::size_t row,
                  StokesTable &out) const;

  // pose_sums.cpp
  void take_from_card(const Prepared &at, SumsStore &out) const;
  void sum_facets(const Prepared &at, SumsStore &out) const; ///< by kernels
  void add_general(const Pose &pose, const Prepared &at, Workspace &work) const;
  /// `may_vary`: something has added variances besides masks and listed facets.
  void take_roots(Workspace &work, bool may_vary = false) const;
  void take_variances(Workspace &work) const;
  void add_rounding(Workspace &work) const;
  void light_of_general(const Pose &pose, const Prepared &at, const backend::SeenFacet &facet,
                        const Workspace &work, Stokes<ScatteringPlane> *bands) const;
  [[nodiscard]] SurfaceDirections directions(const Pose &pose, const Prepared &at,
                                             const backend::SeenFacet &facet) const;
  [[nodiscard]] SlotSums sums_of(std::size_t slot, const Workspace &work) const;

  // refinement.cpp
  void refer_to(const BandLight &all, double unit_m2, Workspace &work) const;
  [[nodiscard]] bool is_uncertain(const BandLight &all, double unit_m2,
                                  const Workspace &work) const;
  void mend(const Pose &pose, const Prepared &at, Workspace &work) const;
  /// The facets of a pose into work.uncertain.
  void list_uncertain(const Pose &pose, const Prepared &at, const backend::MaskErrorModel &error,
                      Workspace &work) const;
  void light_units(std::uint32_t slot, Workspace &work) const;
  [[nodiscard]] Stokes<ScatteringPlane> facet_light(std::size_t k, std::size_t band,
                                                    const Workspace &work) const;
  void weigh_errors(Workspace &work) const;
  void trace(const Pose &pose, const Prepared &at, double part, Workspace &work) const;
  double trace_worst(const Pose &pose, const Prepared &at, double wanted, Workspace &work) const;
  void look_closer(const Pose &pose, const Prepared &at, double wanted, Workspace &work) const;
  void list_doubtful(const Prepared &at, std::uint32_t n, double wanted, Workspace &work) const;
  [[nodiscard]] double traced_variance(double share, double points) const;
  void put_share(std::size_t k, double share, std::size_t points, double variance,
                 Workspace &work) const;
  bool trace_more(const Pose &pose, double allowed, Workspace &work) const;
  void trace_facet(const Pose &pose, std::size_t k, std::size_t points, Workspace &work) const;
  void change_area(std::size_t k, double change, Workspace &work) const;
  /// A variance of the seen area of work.uncertain[k] besides what the sums hold.
  void add_variance(std::size_t k, double variance, Workspace &work) const;
  void add_general_variance(std::size_t k, double deviation, Workspace &work) const;
  void add_slot_variance(std::uint32_t slot, Workspace &work) const;
  void add_up_variances(Workspace &work) const;
  /// Those of the sums, for whoever asks for sums.
  void sum_variances(Workspace &work) const;
};

} // namespace umov
