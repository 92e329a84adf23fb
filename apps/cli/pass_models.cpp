#include "pass_models.h"

#include <umov/jobs/requests.h>

#include <fmt/format.h>
#include <umov/io/scenario.h>
#include <umov/shape/primitives.h>

namespace umov::cli {

void add_pass_model(CLI::App &verb, PassModelOptions &o) {
  auto *scene =
      verb.add_option("--scene", o.scene,
                      "Scenario whose objects give mesh, materials, attitude and bands: by "
                      "their norad, and one without orbit for all others");
  auto *shape = verb.add_option("--model", o.shape,
                                "Every object as a sphere, or a cube in nadir "
                                "attitude")
                    ->check(CLI::IsMember({"sphere", "cube"}));
  shape->excludes(scene);
  verb.add_option("--size-m", o.size_m, "Of --model: radius, or edge [m]")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str()
      ->needs(shape);
  verb.add_option("--material", o.material, "Of --model: a name or a file; see umov material list")
      ->needs(shape);
  verb.add_option("--band", o.band, "Band of the magnitudes; default: the middle one");
}

Result<PassModels> PassModels::make(const PassModelOptions &o, Diagnostics &diagnostics) {
  PassModels out;
  std::vector<Band> bands;
  if (!o.shape.empty()) {
    if (o.material.empty())
      return fail(ErrorCode::Usage,
                  "--model needs --material: nothing is guessed; see umov material list");
    UMOV_ASSIGN(material, read_material(o.material));
    UMOV_ASSIGN(set, bands_from({o.band.empty() ? "nm:550" : o.band}));
    bands = set;
    if (o.shape == "sphere") {
      UMOV_ASSIGN(sphere, PassLight::of_sphere(o.size_m, material, bands));
      out.other_ = sphere;
    } else {
      UMOV_ASSIGN(scene, make_scene(make_chamfered_cube(o.size_m, 0.1 * o.size_m), NormalMode::Flat,
                                    bands, {material}, {material}, diagnostics));
      UMOV_ASSIGN(cube, PassLight::of_body(scene, TwoAxisLaw{}, LightMethod::Auto));
      out.other_ = cube;
    }
    out.description_ =
        fmt::format("{} of {:g} m, {}, {}", o.shape, o.size_m, o.material, bands.front().name);
    return out;
  }
  if (o.scene.empty()) {
    if (!o.band.empty())
      return fail(ErrorCode::Usage, "--band needs --scene or --model");
    return out;
  }
  UMOV_ASSIGN(scenario, read_scenario(o.scene, {}));
  Scenario scene = scenario; // orbits come from the file of the passes
  scene.time.reset();
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    if (!scene.objects[k].parts.empty())
      diagnostics.warn("parts stand as in the mesh: passes do not turn them", {o.scene});
    const int norad = scene.objects[k].orbit ? scene.objects[k].orbit->norad : 0;
    UMOV_ASSIGN(object, load_object(scene, k, {.allow_old_elements = true}, diagnostics));
    UMOV_ASSIGN(light, PassLight::of_body(object.scene, object.attitude, scene.light.method,
                                          scene.light.bounces));
    if (norad > 0 && scene.objects.size() > 1)
      out.by_number_.insert_or_assign(norad, light);
    else
      out.other_ = light;
  }
  UMOV_ASSIGN(band, jobs::band_index(o.band, scene.bands));
  out.band_ = band;
  out.description_ = fmt::format("{}, {}", o.scene, scene.bands[band].name);
  return out;
}

const PassLight *PassModels::of(int norad) const {
  const auto found = by_number_.find(norad);
  if (found != by_number_.end())
    return &found->second;
  return other_ ? &*other_ : nullptr;
}

} // namespace umov::cli
