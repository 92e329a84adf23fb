#pragma once
// Private: the standard cases of `umov bench`.

#include <string>
#include <umov/light/engine.h>
#include <umov/light/light_model.h>
#include <vector>

namespace umov::bench {

/// One line of the report.
struct BenchCase {
  std::string name;
  std::string mesh = "box-wing"; ///< what `case_mesh` knows, or an OBJ file in metres, +Z up
  std::size_t facets = 10'000;
  std::size_t bands = 3;
  bool has_own_roughness = false; ///< per band
  NormalMode normals = NormalMode::Flat;
  Visibility visibility = Visibility::Masks;
  MaskQuality masks = fast_masks;
  double cluster_rad = 0;
  unsigned threads = 1;
  std::string instruction_set = "best";
  bool has_errors = true;         ///< compared with rays
  bool is_single_pose = false;    ///< latency instead of rate
  bool is_series = false;         ///< poses follow each other, without errors
  bool is_intensity_only = false; ///< what polarization costs
  bool is_default_path = false;   ///< through the light model, as `umov run` asks it by default
  bool is_for_many = false;       ///< as `umov signature` asks it by default
  bool has_rough_metals = false;  ///< GGX of alpha 0.15 to 0.3, as tests/cli/test_bounces.py
  std::size_t bounces = 1;        ///< more than 1: through the light model, without errors
  BetweenMethod between = BetweenMethod::Auto;
  bool has_library_materials = false; ///< of the telescope, as in examples/hst_maui.toml
  bool is_on_card = false;            ///< cards add up
  std::size_t batch = 0; ///< poses asked for at a time; 0: as many as the time on a rate allows
};

/// All cases, in the order of the report.
std::vector<BenchCase> standard_cases();
/// Masks without and with rays, fast and fine, on a mesh file.
std::vector<BenchCase> cases_for_mesh(const std::string &file);

/// Cards, one core and all cores beside each other: mesh files, or the three standard objects; 1, 3
/// and 16 bands; the cards with so many poses at a time.
std::vector<BenchCase> card_cases(const std::vector<std::string> &meshes,
                                  const std::vector<std::size_t> &batches);

/// The scene of a case: four materials (foil m = 200, cells 1000, white 20, metal 50) over its
/// groups, or those of the library.
Result<Scene> case_scene(const BenchCase &of, Diagnostics &diagnostics);

} // namespace umov::bench
