#pragma once
// Private: a scene flattened for the facet loops.

#include "backend/scene_data.h"
#include "lightcurve/engine/fresnel_table.h"
#include "lightcurve/engine/mask_points.h"
#include "lightcurve/engine/surface_fit.h"

namespace umov {

/// What colours the sums of one slot.
struct SlotLight {
  std::uint32_t slot = 0;                          ///< of the scene (elements.h)
  std::size_t column = 0;                          ///< of the Fresnel table, first band
  const Surface *surface = nullptr;                ///< of the compiled scene
  bool is_grey = true;                             ///< one lobe for all bands
  std::vector<std::vector<ProductLight>> products; ///< [band][product]
  double diffuse_error = 0;                        ///< of the polynomials, relative
};

struct CompiledScene {
  backend::SceneData<double> data; ///< areas in parts of `area_m2`
  double area_m2 = 1;              ///< of all classes
  std::vector<SlotLight> slots;    ///< as data.slots
  std::vector<double> widths;      ///< per lobe
  FresnelTable fresnel;
  std::size_t general_classes = 0;
};

/// Groups by plan, surfaces by fit. `cluster_rad` > 0 adds the error of joined normals.
CompiledScene compile_scene(const Scene &scene, const FacetClasses &classes, const GroupPlan &plan,
                            double cluster_rad);

/// The same in single precision.
backend::SceneData<float> round_scene(const backend::SceneData<double> &from);

} // namespace umov
