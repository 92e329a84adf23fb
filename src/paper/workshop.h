#pragma once
// What the figures share: the paper's materials and objects, their light, orbits, a stopwatch.

#include <chrono>
#include <map>
#include <memory>
#include <span>
#include <umov/light/poses.h>
#include <umov/lightcurve/compute.h>
#include <umov/orbit/passes.h>
#include <umov/paper/paper.h>
#include <umov/scene/scene.h>

namespace umov {

inline constexpr double degree = pi / 180;

/// Names of Table 1 in its order, and how they are written in text.
struct PaperMaterial {
  const char *name, *title;
};
inline constexpr PaperMaterial paper_materials[] = {{"paper_au", "gold"},
                                                    {"paper_al", "aluminium"},
                                                    {"paper_bk7", "BK7"},
                                                    {"paper_asi", "amorphous silicon"},
                                                    {"paper_spectralon", "Spectralon"},
                                                    {"paper_mylar", "Mylar"}};

/// Of the three bands in plots: blue, green, vermilion.
inline constexpr std::size_t band_colours[] = {4, 2, 5};

/// 425, 550 and 650 nm.
const std::vector<Band> &paper_bands();
/// A built-in material, which must exist; with its body light or without.
Material paper_material(const std::string &name, bool has_body = true);
/// B/A of one reflection: Q/I of any shape of one material without body light.
double interface_q(const Surface &surface, std::size_t band, double phase_deg);
Surface compiled(const Material &material);

/// An object of the paper: mesh and the material of each group.
struct PaperObject {
  Mesh mesh;
  NormalMode normals = NormalMode::Flat;
  std::map<std::string, std::string> materials; ///< mesh group -> material; "default"
};
/// "cube", "cigar", "mli", "mli_crumpled", "hst", "agena" with the materials of the examples; and
/// "box_wing", a made-up satellite of four of the six.
PaperObject paper_object(const std::string &name);
/// The scene of an object; every material through `change`.
Scene paper_scene(
    const PaperObject &object,
    const std::function<Material(Material)> &change = [](Material m) { return m; });

/// Poses `first`, `first` + 1, ... of the random stream of a seed.
std::vector<Pose> random_poses(std::uint64_t seed, std::size_t count, double phase_deg);

/// Q, U or V over I; NaN where dark.
double ratio(double stokes, double i);

class Stopwatch {
public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// A pass of an object with its light.
struct PaperPass {
  SitePass pass;
  LightCurveOutcome light;
};

class PaperWorkshop {
public:
  explicit PaperWorkshop(const PaperOptions &options) : options_(options) {}
  [[nodiscard]] unsigned threads() const { return options_.threads; }
  const Scene &scene(const std::string &object);
  const LightModel &rays(const std::string &object);
  /// Made anew, with the paper's threads.
  [[nodiscard]] std::unique_ptr<LightModel> model(const Scene &scene, LightOptions options) const;
  /// Evaluates; the poses and their time, without preparation, are added to the figure's.
  StokesTable light(const LightModel &model, const std::vector<Pose> &poses,
                    PaperFigure &figure) const;
  /// The same for an object by masks of typical error 0.2 % of I, with rays for uncertain poses.
  StokesTable light(const std::string &object, const std::vector<Pose> &poses, PaperFigure &figure);
  /// Consecutive passes over Maui with at least 100 s above an altitude in sunlight under a dark
  /// sky, from days before the elements to 7 days after them, the earliest first.
  Result<std::vector<SitePass>> passes(const std::string &object, std::size_t count,
                                       Angle altitude_min, double days_before);
  /// Up to eight of "hst" or "agena" above 20 deg with the light, once a second, by rays.
  struct LitPasses {
    std::vector<PaperPass> passes;
    double seconds = 0; ///< that their light took
  };
  Result<const LitPasses *> lit_passes(const std::string &object);
  Result<Trajectory> orbit(const std::string &object) const;

private:
  PaperOptions options_;
  std::map<std::string, Scene> scenes_;
  std::map<std::string, std::unique_ptr<LightModel>> rays_, masks_;
  std::map<std::string, LitPasses> lit_passes_;
};

/// Makers of one figure each.
using FigureMaker = Result<PaperFigure> (*)(PaperWorkshop &);
struct FigureEntry {
  const char *id;
  FigureMaker make;
};
std::span<const FigureEntry> figure_entries();

} // namespace umov
