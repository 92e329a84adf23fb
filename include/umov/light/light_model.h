#pragma once
// The one way from poses to Stokes: for every command, every language and every machine.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <umov/core/result.h>
#include <umov/light/device.h>
#include <umov/light/integrator.h>
#include <umov/light/light_task.h>
#include <umov/light/stokes_table.h>
#include <umov/scene/articulation.h>
#include <umov/scene/pose.h>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// How it is decided what is lit and seen. A convex body hides nothing: it is lit without rays and
/// without masks whatever is asked.
enum class LightMethod : std::uint8_t {
  Rays,  ///< each pose by rays, to the accuracy asked: the reference
  Masks, ///< looked up between directions traced beforehand: microseconds; half-widths say how good
  Auto ///< masks where their half-width meets the accuracy, rays where it does not: class by class
       ///< first, whole poses last
};

/// How an object is to be lit.
struct LightOptions {
  LightMethod method = LightMethod::Auto;
  double accuracy = 0.005; ///< wanted relative 95 % half-width of I
  /// In parts of the object's typical light (`typical_light`): below it I need not be known any
  /// better than at it. 0: every pose to `accuracy` of its own I. Absent: 0.1 for Auto, else 0.
  std::optional<double> accuracy_floor = {};
  /// Poses are far apart, as random ones are, and asked for by the million: with Auto, half-widths
  /// leave out what only neighbours in a series share and what no point of the masks has found.
  bool is_for_many_poses = false;
  /// Half-widths are asked for. If not, Masks tell those of sampling alone, and spare what it takes
  /// to know how much curved and joined facets are wrong by.
  bool has_half_widths = true;
  /// Masks are coarse, and normals that lie close together beside their lobe are one: for a search
  /// over all attitudes. Goes with Masks, whose accuracy is 1 % of I then.
  bool is_for_search = false;
  /// Surfaces that the light may touch: 1 is direct light, more adds sampled paths between parts.
  /// Up to 64.
  std::size_t bounces = 1;
  BetweenMethod between = BetweenMethod::Auto; ///< how that light is drawn; Auto here: paths
  std::size_t poses_in_all = 0;                ///< IntegrationOptions::poses_in_all
  std::uint64_t seed = 0; ///< of point sets and paths; results depend on it within the error only
  /// Light of the source per unit irradiance, in the scattering plane: sunlight, or a laser's
  /// (which takes rays).
  Stokes<ScatteringPlane> source{1, 0, 0, 0};
  /// Ray-tested points per pose, past which the error is reported as it is; 0: as the light needs
  /// (point_budget.h: for rays, for what Auto leaves to them, for paths with bounces).
  std::size_t max_points = 0;
  /// File to keep the masks in: read if it exists (BadInput unless it fits), made if not.
  std::filesystem::path mask_file = {};
  /// Folder of masks of earlier jobs; empty: none are kept. What is damaged is made anew.
  std::filesystem::path mask_cache = {};
  unsigned threads = 0; ///< of the preparation; 0: all cores
  /// Who adds up what masks say is seen. Cuda is refused (Usage) where no masks are used or parts
  /// turn; Auto takes the processor there, and says why in LightFacts::device.
  DeviceOptions device = {};
};

class LightModel;

/// What models of other materials on the same mesh have of the chains of light between surfaces
/// (BetweenMethod::Chains) that one of them draws.
struct ChainFamily {
  /// Scenes for whose light they are drawn, too.
  std::vector<Scene> also = {};
  /// Whose chains are taken, without new rays, where they serve (ChainSharing).
  std::shared_ptr<const LightModel> elder = nullptr;
};

/// What was made ready.
struct LightFacts {
  LightMethod method = LightMethod::Rays; ///< Rays where Auto takes nothing else
  bool is_convex = false;
  std::size_t triangles = 0, classes = 0;
  double setup_s = 0;
  std::vector<double> floor_i; ///< per band [m2/sr]: the accuracy refers to it at least; empty: 0
  std::string visibility;      ///< how hiding is decided, in words for a file's header
  std::string instruction_set; ///< "scalar double" for rays
  std::string device;          ///< names of cards; of Auto without them "cpu" and why; else empty
};

/// A scene, its parts free to turn, ready to be lit from any direction. Thread safe. A pose's light
/// depends on the pose alone, not on which or how many others are asked for with it (light between
/// surfaces apart: neighbours in a series share their paths, within the half-widths).
class LightModel {
public:
  virtual ~LightModel() = default;
  LightModel(const LightModel &) = delete;
  LightModel &operator=(const LightModel &) = delete;

  /// Stokes of every pose, directions in the body; joint angles [pose * joints + joint] [rad];
  /// `out` is resized, to the bands of the scene: those with a curve are summed here, and nowhere
  /// else, from the wavelengths at which the light is computed (docs/theory/bands.md). False if
  /// `task.cancel` became true: the table is then of no use.
  [[nodiscard]] bool evaluate(std::span<const Pose> poses, std::span<const double> angles_rad,
                              StokesTable &out, const LightTask &task = {}) const;
  /// The same for parts that stand as the mesh has them.
  [[nodiscard]] bool evaluate(std::span<const Pose> poses, StokesTable &out,
                              const LightTask &task = {}) const;

  /// The same at each wavelength of the scene's grid, for who weighs them otherwise: through air.
  [[nodiscard]] bool evaluate_at_nodes(std::span<const Pose> poses,
                                       std::span<const double> angles_rad, StokesTable &out,
                                       const LightTask &task = {}) const;

  /// What is lit.
  [[nodiscard]] const Scene &scene() const { return scene_; }
  /// Its parts that turn.
  [[nodiscard]] const std::vector<Joint> &joints() const { return joints_; }
  /// What was made ready.
  [[nodiscard]] const LightFacts &facts() const { return facts_; }
  /// LightFacts::device as it is now: Auto leaves cards for good once masks no longer fit on them
  /// ("cpu in the end, at first NAME: why", and "cpu: why" where they lit nothing).
  [[nodiscard]] virtual std::string device() const { return facts_.device; }
  /// LightFacts::instruction_set as it is now.
  [[nodiscard]] virtual std::string instruction_set() const { return facts_.instruction_set; }
  /// Who has lit so far, as bytes depend on it: the `identity_of` cards, with " and the processor"
  /// where that has lit poses instead of them; empty: the processor alone.
  [[nodiscard]] virtual std::string lit_by() const { return ""; }
  /// Names that material_i counts: fronts in the order of the mesh groups, then backs.
  [[nodiscard]] const std::vector<std::string> &materials() const { return materials_; }
  /// Keeps what was learnt of the masks for later jobs (LightOptions::mask_cache or mask_file).
  /// Device if the file that was asked for cannot be written; the cache fails in silence.
  [[nodiscard]] virtual Result<void> keep_masks() const { return {}; }
  /// Copies from now on what another model has traced of the same masks, in place of tracing it
  /// again; nothing changes where its masks are others, or none. Never both ways, or around.
  virtual void take_masks_of(const LightModel &elder) const { (void)elder; }
  /// The reference path behind light between surfaces; null where there is none, or parts turn.
  /// Throws as Engine.
  [[nodiscard]] virtual std::shared_ptr<const Integrator>
  chain_drawer(const std::atomic<bool> *cancel) const {
    (void)cancel;
    return nullptr;
  }
  /// Bytes of the masks as they are now: rows are traced when they are first asked for.
  [[nodiscard]] virtual std::size_t mask_bytes() const { return 0; }

protected:
  /// For the models that `make_light` chooses from.
  LightModel(const Scene &scene, std::vector<Joint> joints);
  /// Floors at the wavelengths of the grid as those of the bands.
  [[nodiscard]] std::vector<double> of_bands(const std::vector<double> &nodes) const;
  LightFacts facts_;

private:
  /// At the nodes of the scene's grid.
  virtual bool light(std::span<const Pose> poses, std::span<const double> angles_rad,
                     StokesTable &out, const LightTask &task) const = 0;
  Scene scene_;
  std::vector<Joint> joints_;
  std::vector<std::string> materials_;
};

/// What tables of many poses are asked for where nobody says how well: Auto to 0.05 of I, down to
/// 0.02 of the typical light, at about half the rate of masks alone. Other methods, and light
/// of several surfaces, stay as they are.
LightOptions for_many_poses(LightOptions options);

/// "rays", "masks" or "auto".
const char *name_of(LightMethod method);
/// "auto", "paths" or "chains".
const char *name_of(BetweenMethod method);
/// The floor that holds where none is given.
double default_accuracy_floor(LightMethod method);

/// The model for a scene: the one place that decides how it is lit. `joints` have passed
/// check_joints. BadInput for options outside their ranges, a mask file that does not fit, and one
/// for an object whose parts turn; Device where the ray tree cannot be built; Interrupted if
/// `cancel` became true.
Result<std::unique_ptr<LightModel>> make_light(const Scene &scene, std::vector<Joint> joints,
                                               const LightOptions &options,
                                               const std::atomic<bool> *cancel = nullptr,
                                               ChainFamily family = {});

/// The same for hundreds of directions at each epoch, as light of the Earth asks for: direct light
/// by masks alone.
Result<std::unique_ptr<LightModel>> make_light_for_many(const Scene &scene,
                                                        std::vector<Joint> joints,
                                                        LightOptions options,
                                                        const std::atomic<bool> *cancel = nullptr);

/// What the body emits by itself at temperatures [K] of its mesh groups: Stokes [W sr-1 nm-1], from
/// up to options.bounces surfaces. BadInput as ThermalEmission::make; Device and Interrupted as
/// above.
Result<std::unique_ptr<LightModel>> make_thermal_light(const Scene &scene,
                                                       std::vector<Joint> joints,
                                                       std::span<const double> temperature_k,
                                                       const LightOptions &options,
                                                       const std::atomic<bool> *cancel = nullptr);

/// Per node of the scene's grid [m2/sr]: the median over 256 random poses (phase angles spread
/// evenly over 30 to 150 deg) of I if nothing hid anything. A property of the object, so that no
/// row's accuracy depends on which other rows are asked for. Throws Failure (Interrupted) if
/// `cancel` became true.
std::vector<double> typical_light(const Scene &scene, const std::atomic<bool> *cancel = nullptr);

/// Names of all materials of a scene in order of first use (fronts, then backs).
std::vector<std::string> material_names(const Scene &scene);

} // namespace umov
