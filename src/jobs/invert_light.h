#pragma once
// Private: what every question to observations begins with.

#include "jobs/part_light.h"

#include <mutex>
#include <optional>
#include <umov/inverse/between_table.h>
#include <umov/jobs/invert.h>
#include <umov/jobs/pose_light.h>

namespace umov::jobs {

/// Light of an object with what goes from surface to surface: made when it is first asked for, once
/// for all curves.
struct WholeLight {
  std::mutex making;
  std::optional<PoseLight> light;
};
/// Light between surfaces, where the scenario asks for it (`render.bounces`).
struct FittedBetween {
  PoseLight whole;
  /// For the last steps, and for the search.
  std::shared_ptr<BetweenTable> fine, coarse;
};
/// Light of an object as a search wants it.
struct SearchedLight {
  PoseLight light;
  /// For the first fits, where `light` mends them or is exact and slow; else none.
  std::optional<PoseLight> masks;
  /// For the search over all attitudes, if `take_coarse` was asked: coarse masks, and facets joined
  /// that look nearly the same way. None of a body of few facets or of parts that turn.
  std::optional<PoseLight> coarse = {};
  std::optional<FittedBetween> between = {}; ///< beside `light`, which is direct
  /// The light of `light` by material, where that is not quite known and can be taken apart.
  std::unique_ptr<LightByPart> parts = {};
  /// What `share_between` asks.
  std::unique_ptr<WholeLight> whole = std::make_unique<WholeLight>();
};
/// Observations, the object that they are of, and its light.
struct Prepared : SearchedLight {
  ObservedLightCurve observed;
};

/// Reads and compiles what a request names.
Result<Prepared> prepare(const Scenario &scenario, const InvertRequest &request,
                         const JobOptions &options, Diagnostics &diagnostics,
                         const std::atomic<bool> *cancel);
/// The light alone, as exact as the request's errors ask for.
Result<SearchedLight> prepare_light(const Scenario &scenario, const InvertRequest &request,
                                    const JobOptions &options, Diagnostics &diagnostics,
                                    const std::atomic<bool> *cancel = nullptr);
/// Makes light for a search over all attitudes, which forgives a quarter of I at first and a
/// twelfth in the end; without it masks serve.
Result<void> take_coarse(SearchedLight &ready, const Scenario &scenario,
                         const InvertRequest &request, const JobOptions &options,
                         const std::atomic<bool> *cancel = nullptr);
/// The light by material, as little of that as the request says is known; warns where it cannot be
/// had, so that materials are taken for right.
void take_apart(SearchedLight &ready, const InvertRequest &request, const JobOptions &options,
                Diagnostics &diagnostics, const std::atomic<bool> *cancel = nullptr);
/// Light that a search rests on, with the parts that there are. `ready` and `monitor` must outlive
/// it.
PoseLighting searched_lighting(const SearchedLight &ready, unsigned threads,
                               const Monitor &monitor);
/// The same light without parts.
PoseLighting whole_lighting(const SearchedLight &ready, unsigned threads, const Monitor &monitor);
/// The same by masks as they are: for what follows an attitude from one observation to the next.
PoseLighting followed_lighting(const SearchedLight &ready, unsigned threads,
                               const Monitor &monitor);
/// The same for the first fits and for what is far from the peaks: masks as they are, and a coarser
/// table of what goes between surfaces.
PoseLighting first_lighting(const SearchedLight &ready, unsigned threads, const Monitor &monitor);
/// Those parts; none where the materials are known.
std::vector<PartKind> parts_of(const SearchedLight &ready);
/// Light that was made once, without what goes between surfaces. `light` and `monitor` must outlive
/// it.
PoseLighting lighting_of(const PoseLight &light, unsigned threads, const Monitor &monitor);
/// Light for a search: masks as they are, without half-widths, where the last steps mend them. What
/// masks say of themselves is the most that they may miss, thirty times what they do miss where a
/// sliver is in doubt: as an error of its own (`CurveLikelihood`) it would drive a search away from
/// the truth. `ready` and `monitor` must outlive it.
PoseLighting quick_lighting(const SearchedLight &ready, unsigned threads, const Monitor &monitor);
/// Who adds up, as of the light that the answer rests on; warns where that is not what was asked.
ManifestInput::Light light_used(const SearchedLight &ready, const Scenario &scenario,
                                Diagnostics &diagnostics);
/// For later jobs; a cache that cannot be written costs time alone.
void keep_masks(const SearchedLight &ready);
/// How the search is run; `monitor` must outlive it.
SearchOptions search_options(const Scenario &scenario, const InvertRequest &request,
                             const JobOptions &options, const Monitor &monitor);

} // namespace umov::jobs
