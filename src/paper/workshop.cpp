#include "paper/workshop.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/core/embedded.h>
#include <umov/io/elements_file.h>
#include <umov/io/sites.h>
#include <umov/shape/primitives.h>

UMOV_EMBEDDED(paper_tle_hst)
UMOV_EMBEDDED(paper_tle_agena)
UMOV_EMBEDDED(paper_tle_explorer27)
UMOV_EMBEDDED(paper_tle_goes15)

namespace umov {
namespace {

// Everything compiled in is right by construction: a failure here is a bug, told as such.
template <class T> T must(Result<T> result) {
  if (!result)
    throw std::logic_error("paper: " + result.error().text());
  return std::move(*result);
}

const std::map<std::string, std::string> hst_materials{
    {"light_shield", "paper_al"},     {"baffle", "paper_al"},
    {"forward_shell", "paper_mylar"}, {"equipment", "paper_al"},
    {"aft_shroud", "paper_al"},       {"door", "paper_al"},
    {"array_front", "paper_asi"},     {"array_back", "paper_mylar"},
    {"array_frame", "paper_al"},      {"antenna", "paper_spectralon"},
    {"handrail", "paper_au"}};
const std::map<std::string, std::string> agena_materials{
    {"nozzle_titanium", "paper_al"}, {"rack_aluminium", "paper_al"},
    {"tank_aluminium", "paper_al"},  {"paint_white", "paper_spectralon"},
    {"paint_black", "paper_bk7"},    {"cap_gold_kapton", "paper_au"}};

AttitudeLaw attitude_of(const std::string &object) {
  if (object == "hst") // as in examples/hst_paper.toml: it looks at the Orion nebula
    return TwoAxisLaw{
        {0, 0, 1}, CelestialDirection{83.8 * degree, -5.4 * degree}, {1, 0, 0}, Target::Sun};
  return TwoAxisLaw{{0, 0, 1}, Target::Zenith, {1, 0, 0}, Target::Velocity};
}

/// The span in which elements are fresh enough for the paper's passes.
constexpr double elements_days = 7;

} // namespace

const std::vector<Band> &paper_bands() {
  static const std::vector<Band> bands = must(bands_from({"paper_rgb"}));
  return bands;
}

Material paper_material(const std::string &name, bool has_body) {
  Material out = must(builtin_material(name));
  if (!has_body)
    out.body.reset();
  return out;
}

Surface compiled(const Material &material) {
  return must(Surface::compile(material, paper_bands()));
}

double interface_q(const Surface &surface, std::size_t band, double phase_deg) {
  const FresnelFactors f = surface.fresnel(band, std::cos(phase_deg * degree));
  return f.a > 0 ? f.b / f.a : std::nan("");
}

PaperObject paper_object(const std::string &name) {
  if (name == "cube")
    return {make_chamfered_cube(1, 0.1), NormalMode::Flat, {{"default", "paper_au"}}};
  if (name == "cigar")
    return {make_ellipsoid(0.25, 0.25, 1, 5000), NormalMode::Smooth, {{"default", "paper_au"}}};
  if (name == "mli" || name == "mli_crumpled")
    return {make_mli_sheet(1, name == "mli" ? 0 : 0.3),
            NormalMode::Flat,
            {{"front", "paper_au"}, {"back", "paper_al"}}};
  if (name == "agena")
    return {make_agena(), NormalMode::Smooth, agena_materials};
  if (name == "box_wing")
    return {make_box_wing({.facets = 2000, .crumple_m = 0.01}),
            NormalMode::Flat,
            {{"bus", "paper_au"},
             {"panels", "paper_asi"},
             {"dish", "paper_spectralon"},
             {"tank", "paper_al"}}};
  return {make_hst(), NormalMode::Smooth, hst_materials};
}

Scene paper_scene(const PaperObject &object, const std::function<Material(Material)> &change) {
  std::vector<Material> materials;
  for (const std::string &group : object.mesh.groups) {
    const auto named = object.materials.find(group);
    materials.push_back(change(paper_material(
        named != object.materials.end() ? named->second : object.materials.at("default"))));
  }
  Diagnostics diagnostics;
  return must(
      make_scene(object.mesh, object.normals, paper_bands(), materials, materials, diagnostics));
}

std::vector<Pose> random_poses(std::uint64_t seed, std::size_t count, double phase_deg) {
  std::vector<Pose> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(random_pose(seed, i, Angle::degrees(phase_deg)));
  return out;
}

double ratio(double stokes, double i) { return i > 0 ? stokes / i : std::nan(""); }

const Scene &PaperWorkshop::scene(const std::string &object) {
  auto found = scenes_.find(object);
  if (found == scenes_.end())
    found = scenes_.emplace(object, paper_scene(paper_object(object))).first;
  return found->second;
}

std::unique_ptr<LightModel> PaperWorkshop::model(const Scene &scene, LightOptions options) const {
  options.threads = threads();
  return must(make_light(scene, {}, options));
}

const LightModel &PaperWorkshop::rays(const std::string &object) {
  auto &out = rays_[object];
  if (!out)
    out = model(scene(object), {.method = LightMethod::Rays});
  return *out;
}

StokesTable PaperWorkshop::light(const LightModel &model, const std::vector<Pose> &poses,
                                 PaperFigure &figure) const {
  StokesTable out;
  const Stopwatch watch;
  if (!model.evaluate(poses, out, {.threads = threads()}))
    throw std::logic_error("paper: stopped by nobody");
  figure.seconds += watch.seconds();
  figure.realizations += poses.size();
  return out;
}

StokesTable PaperWorkshop::light(const std::string &object, const std::vector<Pose> &poses,
                                 PaperFigure &figure) {
  auto &masks = masks_[object];
  if (!masks)
    masks = model(scene(object), {.method = LightMethod::Masks});
  return light(*masks, poses, figure);
}

Result<Trajectory> PaperWorkshop::orbit(const std::string &object) const {
  const std::string_view text = object == "hst"      ? paper_tle_hst()
                                : object == "agena"  ? paper_tle_agena()
                                : object == "goes15" ? paper_tle_goes15()
                                                     : paper_tle_explorer27();
  Diagnostics diagnostics;
  UMOV_ASSIGN(sets, read_elements(text, object + ".tle", {}, diagnostics));
  return Trajectory(sets.front());
}

Result<std::vector<SitePass>> PaperWorkshop::passes(const std::string &object, std::size_t count,
                                                    Angle altitude_min, double days_before) {
  UMOV_ASSIGN(path, orbit(object));
  UMOV_ASSIGN(site, site_from("maui"));
  PassSearch search;
  search.altitude_min = altitude_min;
  const Epoch<Utc> epoch = path.elements()->epoch;
  UMOV_ASSIGN(found, find_passes(path, site, plus_seconds(epoch, -86400 * days_before),
                                 plus_seconds(epoch, 86400 * elements_days), search));
  std::vector<SitePass> all = std::move(found.passes);
  constexpr double shortest_s = 100;
  std::erase_if(all, [](const SitePass &pass) { return !(pass.visible_s >= shortest_s); });
  if (all.size() > count)
    all.resize(count);
  return all;
}

Result<const PaperWorkshop::LitPasses *> PaperWorkshop::lit_passes(const std::string &object) {
  LitPasses &out = lit_passes_[object];
  if (!out.passes.empty())
    return &out;
  UMOV_ASSIGN(geometry, passes(object, 8, Angle::degrees(20), elements_days));
  UMOV_ASSIGN(path, orbit(object));
  UMOV_ASSIGN(site, site_from("maui"));
  LightCurveRequest request;
  request.object = object;
  request.track.orbit = path;
  request.track.site = site;
  request.only = {Angle::degrees(20), Angle::degrees(-6), true};
  request.track.attitude = attitude_of(object);
  request.frame = PolarizationFrame::Scattering;
  request.track.has_solar_disk = false;
  request.threads = threads();
  const std::atomic<bool> never{false};
  const LightModel &light = rays(object); // set-up: not part of the time
  const Stopwatch watch;
  for (const SitePass &pass : geometry) {
    request.span.start = pass.rise.time;
    request.span.stop = pass.set.time;
    UMOV_ASSIGN(found, compute_light_curve(request, light, nullptr, {}, never));
    out.passes.push_back({pass, std::move(found)});
  }
  out.seconds = watch.seconds();
  return &out;
}

} // namespace umov
