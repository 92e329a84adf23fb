#include "jobs/pass_models.h"

#include <fmt/format.h>
#include <umov/shape/primitives.h>

namespace umov::jobs {

Result<PassModels> PassModels::of_body(const PassModel &wanted, Diagnostics &diagnostics) {
  PassModels out;
  if (wanted.material.empty())
    return fail(ErrorCode::Usage,
                "--model needs --material: nothing is guessed; see umov material list");
  UMOV_ASSIGN(material, read_material(wanted.material));
  UMOV_ASSIGN(bands, bands_named({wanted.band.empty() ? "nm:550" : wanted.band}));
  const bool is_sphere = wanted.body == PassModel::Body::Sphere;
  if (is_sphere) {
    UMOV_ASSIGN(sphere, PassLight::of_sphere(wanted.size_m, material, bands));
    out.other_ = sphere;
  } else {
    UMOV_ASSIGN(scene, make_scene(make_chamfered_cube(wanted.size_m, 0.1 * wanted.size_m),
                                  NormalMode::Flat, bands, {material}, {material}, diagnostics));
    UMOV_ASSIGN(cube,
                PassLight::of_body({std::move(scene), TwoAxisLaw{}, {}}, pass_light_options()));
    out.other_ = cube;
  }
  out.description_ =
      fmt::format("{} {:g} m, {}, {}", is_sphere ? "sphere of radius" : "cube with edges of",
                  wanted.size_m, wanted.material, bands.front().name);
  return out;
}

namespace {

/// [render] of a scenario; where it asks for no accuracy, that of ranges over a pass.
LightOptions options_of(const Scenario &scene, const JobOptions &job) {
  LightOptions out = light_options(scene, job);
  if (!scene.places.contains("render.accuracy")) {
    const LightOptions ranges = pass_light_options();
    out.accuracy = ranges.accuracy;
    out.max_points = ranges.max_points;
  }
  return out;
}

} // namespace

Result<PassModels> PassModels::of_scene(const PassModel &wanted, const JobOptions &options,
                                        Diagnostics &diagnostics, const std::atomic<bool> *cancel) {
  PassModels out;
  Scenario scene = *wanted.scene;
  UMOV_TRY(check_magnitudes(scene));
  scene.time.reset(); // orbits come from the file of the passes
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    const int norad = scene.objects[k].orbit ? scene.objects[k].orbit->norad : 0;
    UMOV_ASSIGN(object,
                load_object(scene, k, {.allow_old_elements = true, .cancel = cancel}, diagnostics));
    UMOV_ASSIGN(
        light, PassLight::of_body({std::move(object.scene), object.attitude, scene.objects[k].parts,
                                   scene.has_solar_disk, scene.magnitudes, scene.air},
                                  options_of(scene, options), cancel));
    if (norad > 0)
      out.by_number_.insert_or_assign(norad, light);
    else
      out.other_ = light;
  }
  out.has_air_ = scene.air.has_value();
  UMOV_ASSIGN(band, band_index(wanted.band, scene.bands));
  out.band_ = band;
  out.description_ = fmt::format("{}, {}", scene.file, scene.bands[band].name);
  return out;
}

Result<PassModels> PassModels::make(const PassModel &wanted, const JobOptions &options,
                                    Diagnostics &diagnostics, const std::atomic<bool> *cancel) {
  if (wanted.body != PassModel::Body::None)
    return of_body(wanted, diagnostics);
  if (wanted.scene)
    return of_scene(wanted, options, diagnostics, cancel);
  if (!wanted.band.empty())
    return fail(ErrorCode::Usage, "--band needs --scene or --model");
  return PassModels{};
}

Result<void> PassModels::keep_masks() const {
  for (const auto &[norad, light] : by_number_)
    UMOV_TRY(light.keep_masks());
  return other_ ? other_->keep_masks() : Result<void>();
}

const PassLight *PassModels::of(int norad) const {
  const auto found = by_number_.find(norad);
  if (found != by_number_.end())
    return &found->second;
  return other_ ? &*other_ : nullptr;
}

} // namespace umov::jobs
