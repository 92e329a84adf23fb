#pragma once
// From a track and a light model to a light curve over time.

#include <functional>
#include <memory>
#include <umov/core/diagnostics.h>
#include <umov/core/journal.h>
#include <umov/light/light_model.h>
#include <umov/lightcurve/earth_light.h>
#include <umov/lightcurve/extinction.h>
#include <umov/lightcurve/light_curve.h>
#include <umov/observation/epochs.h>

namespace umov {

/// Axes that q, u and pa refer to.
enum class PolarizationFrame { Equatorial, AltAz, Scattering };
/// "equatorial", "altaz" or "scattering", as in scenarios and headers.
const char *name_of(PolarizationFrame frame);

/// What a light curve is asked of.
struct LightCurveRequest {
  std::string object;
  TrackRequest track;
  EpochSpan span;
  EpochFilter only;
  PolarizationFrame frame = PolarizationFrame::Equatorial;
  MagnitudeSystem magnitudes = MagnitudeSystem::AB;
  std::optional<EarthshineOptions> earthshine; ///< absent: none
  bool has_moonlight = false;
  std::optional<Air> air; ///< over the site; absent: rows above the air alone
  /// Sunlight at the Earth's edge bent and reddened by its air: I takes `refracted_sunlight` of its
  /// band where `sunlit` of the geometry has none of it.
  bool has_refracted_shadow = false;
  LightOptions light;
  unsigned threads = 0;
};

/// A light curve, its passes, and why it ended early if it did.
struct LightCurveOutcome {
  LightCurve curve;
  std::vector<Pass> passes;       ///< those with at least one kept epoch
  std::size_t passes_seen = 0;    ///< above the altitude limit, kept or not
  std::size_t epochs_in_gaps = 0; ///< that an ephemeris with gaps does not cover: no rows
  std::optional<Error> stopped;   ///< Physics or Interrupted: rows before it are complete
};

/// Called with the number of finished and of all epochs.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// What a light curve is computed with.
struct LightModels {
  std::unique_ptr<LightModel> light;
  /// For light of the Earth and the Moon, asked for hundreds of directions at each epoch; null
  /// where neither is wanted.
  std::unique_ptr<LightModel> many_directions;

  /// LightModel::keep_masks of both.
  [[nodiscard]] Result<void> keep_masks() const;
  /// LightModel::device of the one that has left its cards, else of `light`.
  [[nodiscard]] std::string device() const;
};

/// Models for what is asked of a scene.
Result<LightModels> make_light_models(const LightCurveRequest &request, const Scene &scene,
                                      const std::atomic<bool> *cancel = nullptr);

/// Where the blocks of a light curve that are finished are kept and found again, and under which
/// part of the job; null: nowhere.
struct KeptBlocks {
  Journal *journal = nullptr;
  std::uint64_t part = 0;
};

/// Computes the light curve of `light`'s object. Results are the same bits for any number of
/// threads, and whether or not blocks are found in the journal. When SGP4 fails (decayed orbit) or
/// `cancel` becomes true the finished rows are kept and `stopped` says why. `many_directions` as in
/// LightModels.
Result<LightCurveOutcome>
compute_light_curve(const LightCurveRequest &request, const LightModel &light,
                    const LightModel *many_directions, const Progress &progress,
                    const std::atomic<bool> &cancel, KeptBlocks blocks = {});
/// Some of the passes of a span, with the epochs that must be lit beside theirs.
struct PassCut {
  KeptEpochs kept;        ///< whole blocks where light between surfaces is shared in blocks
  std::size_t before = 0; ///< epochs of it that lie before the first pass wanted
  std::size_t rows = 0;   ///< epochs of the passes wanted
};
/// Passes [first, first + count) of all that were kept: their rows are those of the whole span.
PassCut cut_passes(const KeptEpochs &all, std::size_t first, std::size_t count,
                   const LightModel &light, const LightCurveRequest &request);
/// The epochs that a request keeps. Physics for elements that cannot even start; Interrupted.
Result<KeptEpochs> kept_epochs(const LightCurveRequest &request, const std::atomic<bool> &cancel);
/// The light curve of a cut; `passes_seen` and gaps are those of the whole span.
Result<LightCurveOutcome> compute_cut(const LightCurveRequest &request, PassCut cut,
                                      const LightModel &light, const LightModel *many_directions,
                                      const Progress &progress, const std::atomic<bool> &cancel,
                                      KeptBlocks blocks = {});
/// The same with models made for `request`.
Result<LightCurveOutcome> compute_light_curve(const LightCurveRequest &request, const Scene &scene,
                                              const Progress &progress,
                                              const std::atomic<bool> &cancel);

} // namespace umov
