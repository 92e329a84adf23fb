// Figures 4 to 7, 9, 11, 17, 19 and 21: pictures.

#include "paper/pictures.h"

#include "paper/figures/figures.h"
#include "paper/row_table.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/shape/primitives.h>
#include <umov/shape/rough_surface.h>

namespace umov {
namespace {

/// Adds a picture and counts it.
Result<void> add(PaperFigure &figure, const Scene &scene, const PictureView &view,
                 PictureStyle style, const std::string &caption, unsigned threads) {
  const Stopwatch watch;
  UMOV_ASSIGN(png, picture_png(scene, view, style, threads));
  figure.seconds += watch.seconds();
  ++figure.realizations;
  figure.pictures.push_back({caption, std::move(png)});
  return {};
}

Result<Scene> scene_of(const Mesh &mesh, NormalMode normals, const Material &material) {
  Diagnostics diagnostics;
  const std::vector<Material> all(mesh.groups.size(), material);
  return make_scene(mesh, normals, paper_bands(), all, all, diagnostics);
}

/// A polymer thread: two widths of slopes along and across, a colour from below the surface.
Material satin(double along, double across, std::array<double, 3> colour) {
  Material out = paper_material("paper_bk7");
  out.name = "satin";
  out.index = constant_index(1.55);
  out.distribution = {"ashikhmin_shirley", {{"nu", along}, {"nv", across}}, {}, {}, {}};
  out.direction = Vec3<Body>{1, 0, 0};
  out.body = BodyLobe{Tabulated{{425, 550, 650}, {colour[0], colour[1], colour[2]}}, true};
  return out;
}

Mesh draped_sheet(double slope, std::uint64_t seed) {
  const auto field = make_height_field({.cells = 160,
                                        .cell_m = 2. / 160,
                                        .slope = slope,
                                        .correlation_cells = 20,
                                        .hurst = 0,
                                        .seed = seed});
  return mesh_of(*field);
}

} // namespace

Result<PaperFigure> make_fig4(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig4";
  out.title = "Figure 4: draped cloth";
  out.claim = "A computed picture of satin cloth over a table.";
  UMOV_ASSIGN(scene,
              scene_of(draped_sheet(0.35, 4), NormalMode::Smooth, satin(6, 120, {.18, .02, .24})));
  UMOV_TRY(add(out, scene, view_from({0.5, -1, 1.1}, {0, 0, 1}, 55, 60), PictureStyle::Colour,
               "a draped sheet with threads along one axis", workshop.threads()));
  UMOV_TRY(add(out, scene, view_from({0.5, -1, 1.1}, {0, 0, 1}, 55, 60), PictureStyle::Polarization,
               "its linear polarization", workshop.threads()));
  out.summary = "a satin-like sheet by an anisotropic distribution of normals";
  out.found = {"An Ashikhmin-Shirley distribution (exponents 6 along, 120 across the threads) over "
               "coloured body light. Woven cloth with its own geometry is left out."};
  return out;
}

Result<PaperFigure> make_fig5(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig5";
  out.title = "Figure 5: a frosted globe";
  out.claim = "A computed picture of a transparent globe with a rough surface.";
  for (const double m : {8., 400.}) {
    Material glass = paper_material("paper_bk7");
    glass.distribution = blinn_phong(m);
    glass.body = BodyLobe{Tabulated{{425, 550, 650}, {.28, .25, .22}}, true};
    UMOV_ASSIGN(scene, scene_of(make_sphere(1, 20'000), NormalMode::Smooth, glass));
    UMOV_TRY(add(out, scene, view_from({0, -1, 0.3}, {0, 0, 1}, 60, 40), PictureStyle::Colour,
                 m < 100 ? "frosted, m = 8" : "polished, m = 400", workshop.threads()));
  }
  out.summary = "a frosted sphere; light through the globe is left out";
  out.found = {
      "The surface is that of frosted glass over a weak white scatterer. Light that goes "
      "through the globe and out again is left out: umov traces light in vacuum, and treats "
      "what is below a surface as its material."};
  return out;
}

Result<PaperFigure> make_fig6(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig6";
  out.title = "Figure 6: satin on a spindle";
  out.claim = "A photograph and a computed picture of purple satin tape on a spindle look alike.";
  UMOV_ASSIGN(scene, scene_of(make_cylinder(0.4, 2, 96), NormalMode::Smooth, [] {
                Material out_of = satin(8, 150, {.22, .02, .24});
                out_of.direction = Vec3<Body>{0, 0, 1};
                return out_of;
              }()));
  UMOV_TRY(add(out, scene, view_from({0, -1, 0.1}, {0.4, 0, 1}, 40, 20), PictureStyle::Colour,
               "threads along the axis", workshop.threads()));
  Material around = satin(150, 8, {.22, .02, .24});
  around.direction = Vec3<Body>{0, 0, 1};
  UMOV_ASSIGN(other, scene_of(make_cylinder(0.4, 2, 96), NormalMode::Smooth, around));
  UMOV_TRY(add(out, other, view_from({0, -1, 0.1}, {0.4, 0, 1}, 40, 20), PictureStyle::Colour,
               "threads around the axis", workshop.threads()));
  out.summary = "the streak turns with the threads; there is no photograph to hold it against";
  out.found = {
      "The bright streak runs along the spindle or around it as the threads do. The paper's "
      "photograph is not at hand: no claim of likeness is made here."};
  return out;
}

Result<PaperFigure> make_fig7(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig7";
  out.title = "Figure 7: a microfacet surface and a fractal surface";
  out.claim = "Facets with their normals, and a fractal surface of 130,000 facets.";
  UMOV_ASSIGN(plain, make_height_field({.cells = 256,
                                        .cell_m = 1. / 256,
                                        .slope = 0.4,
                                        .correlation_cells = 16,
                                        .hurst = 0,
                                        .seed = 7}));
  UMOV_ASSIGN(fractal, make_height_field({.cells = 256,
                                          .cell_m = 1. / 256,
                                          .slope = 0.4,
                                          .correlation_cells = 32,
                                          .hurst = 0.8,
                                          .seed = 7}));
  RowTable rows({{"surface", "", "kind"},
                 {"theta", "deg", "facet normal from the mean normal, middle of the bin"},
                 {"density", "1/sr", "facet area per macroscopic area and solid angle"},
                 {"blinn_phong", "1/sr", "(m + 2)/(2 pi) cos^m, m of the same slopes"}});
  PlotFigure plot{"Distribution of facet normals", "from the mean normal [deg]", "D [1/sr]", {}};
  for (const auto &[name, field] :
       {std::pair{"one scale", &plain}, {"fractal, H = 0.8", &fractal}}) {
    const Mesh mesh = mesh_of(*field);
    constexpr std::size_t bins = 30;
    constexpr double width = 2 * degree;
    std::vector<double> area(bins);
    for (const Triangle &t : mesh.triangles) {
      const Vec3<Body> twice = area_vector_doubled(mesh, t);
      const auto bin = static_cast<std::size_t>(std::acos(twice.z / norm(twice)) / width);
      if (bin < bins)
        area[bin] += norm(twice) / 2;
    }
    PlotLine line{name, {}, {}, plot.lines.size(), plot.lines.empty() ? "solid" : "dash"};
    const double m =
        2 / (2 * 0.4 * 0.4) - 2; // Walter et al. 2007: alpha^2 = 2/(m + 2), alpha = sqrt 2 slope
    for (std::size_t k = 0; k < bins; ++k) {
      const double low = static_cast<double>(k) * width, middle = low + width / 2;
      const double solid = 2 * pi * (std::cos(low) - std::cos(low + width));
      const double density = area[k] / solid;
      rows.row(
          {name, middle / degree, density, (m + 2) / (2 * pi) * std::pow(std::cos(middle), m)});
      line.x.push_back(middle / degree);
      line.y.push_back(density);
    }
    plot.lines.push_back(std::move(line));
    UMOV_ASSIGN(scene, scene_of(mesh, NormalMode::Flat, paper_material("paper_al")));
    UMOV_TRY(add(out, scene, view_from({0.4, -1, 0.8}, {0, 0, 1}, 70, 30), PictureStyle::Intensity,
                 fmt::format("{}: {} facets", name, mesh.triangles.size()), workshop.threads()));
  }
  PlotLine gauss{"Gaussian slopes (Beckmann)", {}, {}, 2, "dot"};
  for (double deg = 1; deg < 60; deg += 1) {
    const double tangent = std::tan(deg * degree), cosine = std::cos(deg * degree), a2 = 2 * .16;
    gauss.x.push_back(deg);
    gauss.y.push_back(std::exp(-tangent * tangent / a2) / (pi * a2 * std::pow(cosine, 4)));
  }
  plot.lines.push_back(gauss);
  out.plots = {std::move(plot)};
  out.data = {{"fig7", rows.table()}};
  out.summary = "131,072 facets each; their normals are those of Gaussian slopes";
  out.found = {"Both surfaces have an rms slope of .4 along each axis. Statistical models are held "
               "against such surfaces, with all reflections traced (docs/theory/lobes.md)."};
  return out;
}

Result<PaperFigure> make_fig9(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig9";
  out.title = "Figure 9: anisotropic silk";
  out.claim = "Highlights of silk depend on the direction of its threads.";
  for (const auto &[nu, nv, caption] : {std::tuple{100., 100., "even: 100 and 100"},
                                        {10., 400., "10 along, 400 across"},
                                        {400., 10., "400 along, 10 across"}}) {
    UMOV_ASSIGN(
        scene, scene_of(draped_sheet(0.25, 9), NormalMode::Smooth, satin(nu, nv, {.14, .03, .24})));
    UMOV_TRY(add(out, scene, view_from({0.2, -0.6, 1}, {0, 1, 0.3}, 50, 45), PictureStyle::Colour,
                 caption, workshop.threads()));
  }
  out.summary = "the same sheet with three pairs of exponents";
  out.found = {"Ashikhmin & Shirley's distribution, threads from left to right."};
  return out;
}

Result<PaperFigure> make_fig11(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig11";
  out.title = "Figure 11: one polarization blocked";
  out.claim = "A floor under large incidence, with and without a polarizer that rejects the field "
              "perpendicular to the plane of incidence: the glare goes, the colour stays.";
  Material tile = paper_material("paper_bk7");
  tile.distribution = blinn_phong(30);
  tile.body = BodyLobe{Tabulated{{425, 550, 650}, {.05, .12, .38}}, false};
  UMOV_ASSIGN(scene, scene_of(draped_sheet(0.08, 11), NormalMode::Smooth, tile));
  // The Sun opposite to the observer, both at Brewster's incidence.
  const PictureView view{{0, std::sin(56.6 * degree), std::cos(56.6 * degree)},
                         {0, -std::sin(56.6 * degree), std::cos(56.6 * degree)},
                         {0, 0, 1}};
  UMOV_TRY(add(out, scene, view, PictureStyle::Colour, "no polarizer", workshop.threads()));
  for (const bool is_perpendicular : {true, false}) {
    const Stopwatch watch;
    UMOV_ASSIGN(png, picture_through_polarizer(scene, view, is_perpendicular, workshop.threads()));
    out.seconds += watch.seconds();
    ++out.realizations;
    out.pictures.push_back({is_perpendicular ? "field perpendicular to the plane of incidence"
                                             : "field in the plane: the glare is gone",
                            std::move(png)});
  }
  out.verdict = Verdict::Agrees;
  out.summary = "at Brewster's angle the glare is all in the perpendicular field";
  out.found = {"Glazed tiles: BK7 over a coloured scatterer, at a phase angle of 113 deg."};
  return out;
}

Result<PaperFigure> make_fig17(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig17";
  out.title = "Figure 17: chamfered cube and cigar";
  out.claim = "Meshes of a chamfered cube and of a cigar.";
  for (const char *object : {"cube", "cigar"}) {
    const Scene &scene = workshop.scene(object);
    UMOV_TRY(add(out, scene, view_from({1, -1.6, 0.9}, {0, 0, 1}, 60, 35), PictureStyle::Colour,
                 fmt::format("{}: {} triangles, gold", object, scene.mesh.triangles.size()),
                 workshop.threads()));
  }
  out.summary = "cube of 1 m with .1 m chamfers; cigar of .25 x .25 x 1 m semi-axes";
  out.found = {"Made by `umov mesh make chamfered-cube` and `umov mesh make cigar`."};
  return out;
}

Result<PaperFigure> make_fig19(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig19";
  out.title = "Figure 19: insulation of gold and aluminium";
  out.claim = "A sheet with gold on one side and aluminium on the other.";
  for (const auto &[object, caption] :
       {std::pair{"mli", "flat, gold side"}, {"mli_crumpled", "crumpled, gold side"}}) {
    UMOV_TRY(add(out, workshop.scene(object), view_from({0.3, -0.7, 1}, {0, 0, 1}, 60, 90),
                 PictureStyle::Colour, caption, workshop.threads()));
  }
  UMOV_TRY(add(out, workshop.scene("mli_crumpled"), view_from({0.3, -0.7, -1}, {0, 0, 1}, 60, 90),
               PictureStyle::Colour, "crumpled, aluminium side", workshop.threads()));
  out.summary = "1 m squares, flat and crumpled";
  out.found = {"Made by `umov mesh make mli`, with --crumple-slope 0.3 for the second."};
  return out;
}

Result<PaperFigure> make_fig21(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig21";
  out.title = "Figure 21: HST and Agena";
  out.claim = "Meshes and renderings of both, with the six materials.";
  for (const char *object : {"hst", "agena"}) {
    const Scene &scene = workshop.scene(object);
    const PictureView view = view_from({1, -1.2, 0.7}, {0, 0, 1}, 70, 25);
    const char *const title = object[0] == 'h' ? "HST" : "Agena";
    UMOV_TRY(add(out, scene, view, PictureStyle::Material,
                 fmt::format("{}: {} triangles, by material", title, scene.mesh.triangles.size()),
                 workshop.threads()));
    UMOV_TRY(add(out, scene, view, PictureStyle::Colour, fmt::format("{} in sunlight", title),
                 workshop.threads()));
    UMOV_TRY(add(out, scene, view, PictureStyle::Polarization,
                 fmt::format("{}: linear polarization, 0 (dark) to 100 % (yellow)", title),
                 workshop.threads()));
  }
  out.summary = "from published dimensions, with the six materials of Table 1";
  out.found = {
      "Made by `umov mesh make hst` and `umov mesh make agena`; data/mesh/README.md has the "
      "source of each dimension. Which material stands for which part is a choice, the same "
      "as in the examples."};
  return out;
}

} // namespace umov
