// Figures 2, 3, 8 and 10: what the words mean.

#include "paper/figures/figures.h"
#include "paper/row_table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace umov {

Result<PaperFigure> make_fig2(PaperWorkshop &) {
  PaperFigure out;
  out.id = "fig2";
  out.title = "Figure 2: the phase angle";
  out.claim =
      "The phase angle is the angle between Sun and observer, twice the angle of incidence.";
  const auto ray = [](const char *name, double deg, std::size_t colour, const char *dash) {
    return PlotLine{name, {0, std::sin(deg * degree)}, {0, std::cos(deg * degree)}, colour, dash};
  };
  PlotLine arc{"phase angle, 80 deg", {}, {}, 3, "dot"};
  for (double deg = -10; deg <= 70; deg += 2) {
    arc.x.push_back(0.4 * std::sin(deg * degree));
    arc.y.push_back(0.4 * std::cos(deg * degree));
  }
  out.plots = {{"In the scattering plane",
                "along the surface",
                "along its normal",
                {ray("to the Sun", -10, 1, "solid"), ray("to the observer", 70, 0, "solid"),
                 ray("normal of the microfacet that reflects", 30, 2, "dash"),
                 PlotLine{"surface", {-1, 1}, {0, 0}, 6, "solid"}, arc}}};
  out.summary = "incidence on every contributing microfacet is half the phase angle";
  out.found = {
      "One reflection from Sun to observer needs a microfacet whose normal halves the angle "
      "between them. Its angle of incidence is half the phase angle wherever on the object "
      "it sits and however the surface is turned: everything else follows from this."};
  return out;
}

Result<PaperFigure> make_fig3(PaperWorkshop &) {
  PaperFigure out;
  out.id = "fig3";
  out.title = "Figure 3: four kinds of scattering";
  out.claim = "Mirror reflection, rough reflection, and both with light from below the surface.";
  RowTable rows({{"case", "", "surface"},
                 {"theta_o", "deg", "observer from the normal, mirror side positive"},
                 {"m00", "1/sr", "BRDF at 550 nm, source at 45 deg"},
                 {"q_scat", "", "Q/I"}});
  PlotFigure lobes{
      "BRDF, source at 45 deg", "observer [deg], mirror side positive", "m00 [1/sr]", {}, true};
  PlotFigure polarization{"Q/I of the same", "observer [deg], mirror side positive", "Q/I [%]", {}};
  struct Case {
    const char *name, *material;
    double m;
    bool has_body;
  };
  for (const Case &one :
       {Case{"smooth metal", "paper_al", 5000, false}, Case{"rough metal", "paper_al", 20, false},
        Case{"smooth dielectric over a scatterer", "paper_asi", 5000, true},
        Case{"rough dielectric over a scatterer", "paper_asi", 20, true}}) {
    Material material = paper_material(one.material, one.has_body);
    material.distribution = blinn_phong(one.m);
    const Surface surface = compiled(material);
    const std::size_t k = lobes.lines.size();
    const char *const dashes[] = {"solid", "dash", "dot", "dashdot"};
    PlotLine lobe{one.name, {}, {}, k, dashes[k]}, q{one.name, {}, {}, k, dashes[k]};
    for (double deg = -85; deg <= 85; deg += 0.5) {
      const auto m = surface.brdf(
          1, directions_from_angles(45 * degree, std::abs(deg) * degree, deg >= 0 ? pi : 0));
      rows.row({one.name, deg, m.m[0][0], ratio(m.m[1][0], m.m[0][0])});
      lobe.x.push_back(deg);
      lobe.y.push_back(m.m[0][0] > 1e-5 ? m.m[0][0] : std::nan(""));
      q.x.push_back(deg);
      q.y.push_back(m.m[0][0] > 1e-5 ? 100 * m.m[1][0] / m.m[0][0] : std::nan(""));
    }
    lobes.lines.push_back(lobe);
    polarization.lines.push_back(q);
  }
  out.plots = {lobes, polarization};
  out.data = {{"fig3", rows.table()}};
  out.summary = "as lobes, with what each does to Q";
  out.found = {
      "Roughness widens the lobe and leaves Q/I on one curve of the phase angle; light from "
      "below the surface dilutes it away from the lobe. A fifth case that the paper leaves "
      "out, light that meets several surfaces, is measured among the claims."};
  return out;
}

Result<PaperFigure> make_fig8(PaperWorkshop &) {
  PaperFigure out;
  out.id = "fig8";
  out.title = "Figure 8: shadowing and masking";
  out.claim = "Facets hide one another from the light and from the viewer.";
  RowTable rows({{"m", "", "Blinn-Phong exponent"},
                 {"theta", "deg", "from the normal"},
                 {"masking", "", "P(k): seen share of the projected area of the facets"},
                 {"once", "", "share of light that meets one facet only, F = 1"}});
  PlotFigure seen{"Seen share of the facets P(k)", "from the normal [deg]", "P", {}},
      once{"Light reflected once, all others left out (F = 1)", "incidence [deg]", "albedo", {}};
  for (const double m : {1., 10., 200.}) {
    Material material = paper_material("paper_al");
    material.distribution = blinn_phong(m);
    const Surface surface = compiled(material);
    const std::size_t k = seen.lines.size();
    const char *const dashes[] = {"solid", "dash", "dot"};
    PlotLine p{fmt::format("m = {:g}", m), {}, {}, k, dashes[k]}, e = p;
    for (double deg = 0; deg < 90; deg += 1) {
      const Vec3<Facet> at{std::sin(deg * degree), 0, std::cos(deg * degree)};
      rows.row({m, deg, surface.masking(at), surface.furnace_albedo(at)});
      p.x.push_back(deg);
      p.y.push_back(surface.masking(at));
      e.x.push_back(deg);
      e.y.push_back(surface.furnace_albedo(at));
    }
    seen.lines.push_back(p);
    once.lines.push_back(e);
    const std::map<double, std::array<double, 2>> known{
        {1, {.821021, .564563}}, {10, {.990617, .886667}}, {200, {1, .999994}}};
    for (const std::size_t i : {0u, 1u}) {
      const double deg = i == 0 ? 60 : 75;
      out.checks.push_back({fmt::format("P at {:g} deg, m = {:g}", deg, m),
                            surface.masking({std::sin(deg * degree), 0, std::cos(deg * degree)}),
                            known.at(m)[i], 2e-6, "tests/data/anchors/masking, six digits"});
    }
  }
  out.plots = {seen, once};
  out.data = {{"fig8", rows.table()}};
  out.summary = "as numbers: at m = 10 a ninth of the facets are hidden at 75 deg";
  out.found = {
      "P(k) is exact for the distribution of normals (Smith's function). Light that is "
      "hidden from the viewer meets another facet: at m = 200 less than 3 % of it up to 75 "
      "deg, at m = 1 half of it at any angle."};
  return out;
}

Result<PaperFigure> make_fig10(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig10";
  out.title = "Figure 10: ray tracing against the fast path";
  out.claim = "A ray-traced and a shader-made picture of cloth look alike; the shader is much "
              "faster. Woven cloth is left out of umov.";
  const auto poses = random_poses(10, 200, 100);
  const StokesTable fast = workshop.light("hst", poses, out);
  const auto exact =
      workshop.model(workshop.scene("hst"), {.method = LightMethod::Rays, .accuracy = 0.001});
  PaperFigure slow; // keeps the time of the rays apart
  const StokesTable rays = workshop.light(*exact, poses, slow);
  std::vector<double> errors, q_errors;
  RowTable rows({{"pose", "", "number in the random stream"},
                 {"intensity_rays", "m2 / sr", "ray reference, 550 nm"},
                 {"intensity_masks", "m2 / sr", "direction masks, 550 nm"},
                 {"q_rays", "", "Q/I"},
                 {"q_masks", "", "Q/I"}});
  PlotLine points{"200 poses of HST", {}, {}, 0, "solid"};
  points.has_markers = true;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto a = rays.at(i, 1).stokes;
    const auto b = fast.at(i, 1).stokes;
    rows.row({static_cast<double>(i), a.i, b.i, ratio(a.q, a.i), ratio(b.q, b.i)});
    if (!(a.i > 0) || !(b.i > 0))
      continue;
    errors.push_back(std::abs(b.i / a.i - 1));
    q_errors.push_back(std::abs(b.q / b.i - a.q / a.i));
    points.x.push_back(a.i);
    points.y.push_back(100 * errors.back());
  }
  const auto median = [](std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  PlotFigure differences{
      "Masks against rays", "I by rays [m2/sr]", "difference of I, either way [%]", {points}};
  differences.has_log_x = differences.has_log_y = true; // a pose is all but dark
  out.plots = {differences};
  out.data = {{"fig10", rows.table()}};
  out.verdict = Verdict::Agrees;
  out.summary = fmt::format("masks and rays agree to {:.2f} % in the median", 100 * median(errors));
  out.found = {
      fmt::format("Two ways to decide what hides what, for HST in 200 random attitudes at a "
                  "phase angle of 100 deg: rays to 0.1 % took {:.2g} s, prepared masks "
                  "{:.2g} s. They differ by {:.2f} % of I and {:.1g} of Q/I in the median.",
                  slow.seconds, out.seconds, 100 * median(errors), median(q_errors))};
  out.checks = {{"median difference of I, masks and rays", median(errors), 0, 0.005,
                 "ray reference to 0.1 %; 0.5 % is what these masks promise"}};
  return out;
}

} // namespace umov
