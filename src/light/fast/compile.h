#pragma once
// Private: a scene flattened for the facet loops.

#include "light/fast/colours.h"
#include "light/fast/mask_points.h"
#include "light/fast/shared_materials.h"
#include "light/fast/stores.h"

namespace umov {

/// A scene as sums over facets and what colours them.
struct CompiledScene {
  SceneStore<double> data; ///< areas in parts of `area_m2`
  double area_m2 = 1;      ///< of all classes
  /// Slots of the scene (elements.h) that share their material, as data.slots.
  std::vector<std::vector<std::uint32_t>> slots;
  std::vector<std::optional<SurfaceFit>> fits;         ///< as data.slots; empty: no kernel
  std::vector<double> widths;                          ///< per lobe
  std::vector<backend::LobeRounding<double>> rounding; ///< per lobe
  Colours colours;
  std::size_t general_classes = 0;
  bool has_u = false; ///< something gives U, or V
};

/// Groups by plan, surfaces by fit: those of `scene`, and of `hypotheses`, other materials on the
/// same mesh that the sums are to serve too. `tells_spread`: adds the error of joined normals.
CompiledScene compile_scene(const Scene &scene, const std::vector<Scene> &hypotheses,
                            const SharedSlots &shared, const FacetClasses &classes,
                            const GroupPlan &plan, bool tells_spread, bool is_intensity_only);

/// What a scene's materials make of the sums. BadInput if they were not made for one of them.
Result<Colours> colours_of(const Scene &scene, const CompiledScene &sums, bool is_intensity_only,
                           double &diffuse_error);

/// The same in single precision.
SceneStore<float> round_scene(const SceneStore<double> &from);

} // namespace umov
