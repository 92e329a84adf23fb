// Reflectivity, incidence, atmosphere, multiple scattering.

#include "paper/claims/claims.h"
#include "paper/row_table.h"
#include "paper/statistics.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/io/index_file.h>
#include <umov/io/sites.h>
#include <umov/photometry/passband.h>
#include <umov/shape/primitives.h>

namespace umov {
namespace {

/// Share of a span's dark and sunlit time above 20 deg in which the phase angle exceeds 40 deg.
struct IncidenceShare {
  double hours = 0, share = 0, lowest_deg = 180;
  std::vector<double> incidence_deg; ///< of all such epochs
};
Result<IncidenceShare> incidence_share(const Trajectory &path, const Site &site, Epoch<Utc> start,
                                       double days, double step_s, PaperFigure &figure) {
  IncidenceShare out;
  std::size_t seen = 0, above = 0;
  for (double t = 0; t < days * 86400; t += step_s) {
    const Epoch<Utc> now = plus_seconds(start, t);
    UMOV_ASSIGN(state, path.at(now));
    if (topocentric_altitude(state, now, site).degrees() < 20)
      continue;
    const ObservingGeometry g = observe(state, now, site, ShadowModel::Ellipsoid);
    ++figure.realizations;
    if (g.sun_altitude.degrees() > -6 || !(g.sunlit > 0))
      continue;
    ++seen;
    above += g.phase_angle.degrees() > 40 ? 1u : 0u;
    out.incidence_deg.push_back(g.phase_angle.degrees() / 2);
    out.lowest_deg = std::min(out.lowest_deg, out.incidence_deg.back());
  }
  out.hours = static_cast<double>(seen) * step_s / 3600;
  out.share = seen > 0 ? static_cast<double>(above) / static_cast<double>(seen) : std::nan("");
  return out;
}

/// Q/I of an interface in a band under an airmass of clear air over Haleakala.
Result<double> band_q(const IndexTable &index, const Passband &band, double phase_deg,
                      double airmass) {
  constexpr double pressure_hpa = 707, aerosol = 0.02; // 3058 m; a clean mountain site
  UMOV_ASSIGN(weights, sunlight_weights(band));
  double s0 = 0, s1 = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double nm = band.wavelength_nm[i];
    UMOV_ASSIGN(eta, index_at(index, Wavelength::nm(nm)));
    const MuellerEntries f = Interface(eta).reflection(std::cos(phase_deg / 2 * degree));
    const double passed =
        weights[i] * std::pow(10, -0.4 * airmass * clear_extinction_mag(nm, pressure_hpa, aerosol));
    s0 += passed * f.a;
    s1 += passed * f.b;
  }
  return s1 / s0;
}

/// I and Q of a sphere at 425, 550 and 650 nm.
Result<StokesTable> sphere(const Material &material, const std::vector<double> &phases,
                           PaperWorkshop &workshop, PaperFigure &figure) {
  Diagnostics diagnostics;
  UMOV_ASSIGN(scene, make_scene(make_sphere(1, 5000), NormalMode::Smooth, paper_bands(), {material},
                                {material}, diagnostics));
  std::vector<Pose> poses;
  for (const double phase : phases)
    poses.push_back({{0, 0, 1}, {std::sin(phase * degree), 0, std::cos(phase * degree)}});
  return workshop.light(*workshop.model(scene, {.method = LightMethod::Rays}), poses, figure);
}

} // namespace

Result<PaperFigure> make_claim_reflectivity(PaperWorkshop &) {
  PaperFigure out;
  out.id = "claim_reflectivity";
  out.title = "Do BK7 and Mylar part by total reflectivity?";
  out.claim = "BK7 and Mylar are similar in Q, but BK7 is transparent, so total reflectivity tells "
              "them apart.";
  UMOV_ASSIGN(pet, find_index("PET_Zhang"));
  RowTable rows({{"band", "", "spelled as in a scenario"},
                 {"phase_angle", "deg", "Sun-object-observer"},
                 {"ratio_table1", "", "I of Mylar over I of BK7, both of Table 1, interface"},
                 {"dq_table1", "", "Q/I of Mylar minus Q/I of BK7"},
                 {"ratio_pet", "", "I of measured PET over I of BK7"},
                 {"dq_pet", "", "Q/I of measured PET minus Q/I of BK7"}});
  const Surface bk7 = compiled(paper_material("paper_bk7")),
                mylar = compiled(paper_material("paper_mylar"));
  PlotFigure plot{
      "Reflected light of Mylar over that of BK7", "phase angle [deg]", "ratio of I", {}};
  double green_low = 10, green_high = 0, dq_green = 0, pet_low = 10, pet_high = 0, dq_pet = 0,
         blue_low = 10, red_high = 0;
  for (std::size_t b = 0; b < 3; ++b) {
    const char *const dashes[] = {"solid", "dash", "dot"};
    PlotLine line{paper_bands()[b].name + ", Table 1", {}, {}, band_colours[b], dashes[b]};
    UMOV_ASSIGN(eta, index_at(pet, paper_bands()[b].wavelength));
    for (double phase = 0; phase <= 160; phase += 10) {
      const double c = std::cos(phase * degree);
      const FresnelFactors g = bk7.fresnel(b, c), m = mylar.fresnel(b, c);
      const MuellerEntries p = Interface(eta).reflection(std::cos(phase / 2 * degree));
      rows.row({paper_bands()[b].name, phase, m.a / g.a, m.b / m.a - g.b / g.a, p.a / g.a,
                p.b / p.a - g.b / g.a});
      line.x.push_back(phase);
      line.y.push_back(m.a / g.a);
      if (b == 0)
        blue_low = std::min(blue_low, m.a / g.a);
      if (b == 2)
        red_high = std::max(red_high, m.a / g.a);
      if (b == 1) {
        green_low = std::min(green_low, m.a / g.a);
        green_high = std::max(green_high, m.a / g.a);
        dq_green = std::max(dq_green, std::abs(m.b / m.a - g.b / g.a));
        pet_low = std::min(pet_low, p.a / g.a);
        pet_high = std::max(pet_high, p.a / g.a);
        dq_pet = std::max(dq_pet, std::abs(p.b / p.a - g.b / g.a));
      }
    }
    plot.lines.push_back(std::move(line));
  }
  out.plots = {std::move(plot)};
  out.data = {{"claim_reflectivity", rows.table()}};
  out.verdict = Verdict::Differs;
  out.summary = fmt::format(
      "hardly: the same within {:.0f} % in green and {:.0f} % in red, of an unknown size",
      100 * (1 - green_low), 100 * (red_high - 1));
  out.found = {
      fmt::format(
          "In green the two reflect alike, ratio {:.2f} to {:.2f}, in red at most {:.2f}: that BK7 "
          "transmits and Mylar "
          "absorbs is not seen in what a single surface reflects. Size, distance and "
          "attitude are seldom known to that. In Q they differ by up to {:.3f}, as "
          "little.",
          green_low, green_high, red_high, dq_green),
      fmt::format(
          "In blue Table 1 makes Mylar up to {:.0f} times darker than BK7, by its n = 1.10, which "
          "no polyester has. With the measured index of PET the ratio in green is {:.2f} to "
          "{:.2f}, and Q differs by up to {:.3f}: that can be measured.",
          1 / blue_low, pet_low, pet_high, dq_pet)};
  return out;
}

Result<PaperFigure> make_claim_incidence(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "claim_incidence";
  out.title = "Is incidence above 20 degrees in LEO and for most of GEO?";
  out.claim = "Incident angles on LEO satellites are generally above 20 deg, and for most of the "
              "orbit in GEO.";
  UMOV_ASSIGN(site, site_from("maui"));
  RowTable rows({{"object", "", "name"},
                 {"hours", "h", "above 20 deg, sunlit, dark sky"},
                 {"share", "", "of them with incidence above 20 deg"},
                 {"lowest_incidence", "deg", "half the smallest phase angle"}});
  StoryTable shown{"Share of observable time (above 20 deg, sunlit, Sun below -6 deg, Maui) with "
                   "incidence above 20 deg",
                   {"object", "span", "observable", "share", "lowest incidence"},
                   {}};
  struct Object {
    const char *name, *title;
    double days, step_s;
  };
  PlotFigure plot{
      "Share of observable time above an incidence", "incidence [deg]", "share [%]", {}};
  double leo = 1, geo = 1;
  const Stopwatch watch;
  for (const Object &one :
       {Object{"hst", "HST", 7, 10}, Object{"agena", "Agena", 7, 10},
        Object{"explorer27", "Explorer 27", 7, 10}, Object{"goes15", "GOES 15", 365, 600}}) {
    UMOV_ASSIGN(path, workshop.orbit(one.name));
    UMOV_ASSIGN(found,
                incidence_share(path, site, path.elements()->epoch, one.days, one.step_s, out));
    rows.row({one.title, found.hours, found.share, found.lowest_deg});
    const char *const dashes[] = {"solid", "dash", "dot", "dashdot"};
    PlotLine line{one.title, {}, {}, plot.lines.size(), dashes[plot.lines.size()]};
    for (double limit = 0; limit <= 90; limit += 2) {
      const auto above = std::count_if(found.incidence_deg.begin(), found.incidence_deg.end(),
                                       [&](double deg) { return deg > limit; });
      line.x.push_back(limit);
      line.y.push_back(100. * static_cast<double>(above) /
                       static_cast<double>(std::max<std::size_t>(1, found.incidence_deg.size())));
    }
    plot.lines.push_back(std::move(line));
    shown.rows.push_back(
        {one.title, fmt::format("{:g} days", one.days), fmt::format("{:.1f} h", found.hours),
         fmt::format("{:.0f} %", 100 * found.share), fmt::format("{:.1f} deg", found.lowest_deg)});
    (one.days > 7 ? geo : leo) = std::min(one.days > 7 ? geo : leo, found.share);
  }
  out.seconds = watch.seconds();
  out.plots = {std::move(plot)};
  out.tables = {shown};
  out.data = {{"claim_incidence", rows.table()}};
  out.verdict = leo > 0.9 && geo > 0.5 ? Verdict::Agrees : Verdict::Partly;
  out.summary =
      fmt::format("{:.0f} % of the time or more in LEO, {:.0f} % in GEO", 100 * leo, 100 * geo);
  out.found = {
      "Incidence on what reflects is half the phase angle. GOES 15 is followed for a year from "
      "elements of one day: its place in the sky is good to degrees, which is enough here. Near "
      "the equinoxes at midnight a geostationary satellite is seen at full phase, where nothing "
      "is polarized."};
  return out;
}

Result<PaperFigure> make_claim_atmosphere(PaperWorkshop &) {
  PaperFigure out;
  out.id = "claim_atmosphere";
  out.title = "Is polarization unaffected by the atmosphere?";
  out.claim = "Polarization has the advantage that it is unaffected by the atmosphere.";
  RowTable rows({{"material", "", "measured index"},
                 {"band", "", "full width at half maximum"},
                 {"airmass", "", "clear air over 3058 m"},
                 {"q_scat", "", "Q/I at a phase angle of 140 deg"},
                 {"change", "", "against no atmosphere"}});
  StoryTable shown{
      "Change of Q/I by clear air at airmass 3 (phase angle 140 deg)",
      {"material", "1 nm at 550", "80 nm at 425", "80 nm at 550", "300 nm at 600 (unfiltered)"},
      {}};
  PlotFigure plot{"Gold: change of Q/I by the air", "airmass", "change of Q/I", {}};
  double narrow = 0, medium = 0, broad = 0;
  for (const char *name : {"Au_Johnson", "Cu_Johnson", "Al_Rakic", "NBK7_Schott"}) {
    UMOV_ASSIGN(index, find_index(name));
    std::vector<std::string> line{name};
    struct Wide {
      double centre, width;
      double *largest;
    };
    for (const Wide &wide : {Wide{550, 1, &narrow}, Wide{425, 80, &medium}, Wide{550, 80, &medium},
                             Wide{600, 300, &broad}}) {
      // The widest one is cut where the tables of index end, at 350 nm.
      Passband band = gaussian_passband("", wide.centre, wide.width);
      for (std::size_t i = 0; i < band.wavelength_nm.size(); ++i)
        if (band.wavelength_nm[i] < 350)
          band.response[i] = 0, band.wavelength_nm[i] = 350 + 1e-3 * static_cast<double>(i);
      UMOV_ASSIGN(bare, band_q(index, band, 140, 0));
      PlotLine curve{fmt::format("{:g} nm at {:g} nm", wide.width, wide.centre),
                     {0},
                     {0},
                     plot.lines.size(),
                     plot.lines.size() % 2 == 0 ? "solid" : "dash"};
      for (const double airmass : {1., 2., 3., 4., 5., 6.}) {
        UMOV_ASSIGN(q, band_q(index, band, 140, airmass));
        rows.row({name, fmt::format("{:g} nm at {:g} nm", wide.width, wide.centre), airmass, q,
                  q - bare});
        curve.x.push_back(airmass);
        curve.y.push_back(q - bare);
        if (airmass == 3) {
          line.push_back(fmt::format("{:+.1e}", q - bare));
          *wide.largest = std::max(*wide.largest, std::abs(q - bare));
        }
      }
      if (name == std::string("Au_Johnson"))
        plot.lines.push_back(std::move(curve));
    }
    shown.rows.push_back(std::move(line));
  }
  out.plots = {std::move(plot)};
  out.tables = {shown};
  out.data = {{"claim_atmosphere", rows.table()}};
  out.verdict = Verdict::Partly;
  out.summary = fmt::format("true in a narrow band; {:.4f} in 80 nm, {:.3f} in 300 nm at airmass 3",
                            medium, broad);
  out.found = {
      fmt::format(
          "Extinction multiplies I, Q, U and V alike at each wavelength: Q/I in 1 nm moves by "
          "{:.0e}. In a broad band the air takes blue light first, so it weights the band's own "
          "Q(wavelength) anew.",
          narrow),
      "Clear air by Hansen & Travis 1974 at 707 hPa with an aerosol of optical depth .02. Left "
      "out: "
      "polarized sky background (it must be subtracted, moonlit and twilight skies are strongly "
      "polarized), and seeing, which mixes scintillation into Q where the two polarizations are "
      "measured one after the other."};
  return out;
}

Result<PaperFigure> make_claim_multiple(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "claim_multiple";
  out.title = "Is multiple scattering negligible?";
  out.claim = "At phase angles above 40 deg multiple surface scattering has a negligible effect.";
  RowTable inside(
      {{"material", "", "name in umov"},
       {"m", "", "Blinn-Phong exponent"},
       {"phase_angle", "deg", "Sun-object-observer"},
       {"share", "", "of I at 550 nm of a sphere that met several facets of the surface"},
       {"dq", "", "change of Q/I where that light is unpolarized"}});
  RowTable between(
      {{"object", "", "name"},
       {"phase_angle", "deg", "Sun-object-observer"},
       {"share_median", "", "of I at 550 nm that touched several surfaces, up to five"},
       {"share_high", "", "exceeded by one pose in ten"},
       {"dq_median", "", "|change of Q/I|"},
       {"dq_high", "", "exceeded by one pose in ten"},
       {"v_high", "", "|V/I|, exceeded by one pose in ten"}});
  PlotFigure within{"Within the rough surface (sphere)", "phase angle [deg]", "share of I [%]", {}},
      among{"Between surfaces, up to five (median of 24 poses)",
            "phase angle [deg]",
            "share of I [%]",
            {}};
  const std::vector<double> phases{20, 40, 60, 80, 100, 120, 140, 160};
  double inside_most = 0, between_most = 0, dq_most = 0;
  for (const char *name : {"paper_au", "paper_al"})
    for (const double m : {4., 10., 50., 200.}) {
      Material one = paper_material(name);
      one.distribution = blinn_phong(m);
      UMOV_ASSIGN(single, sphere(one, phases, workshop, out));
      one.interreflection = Interreflection::Unpolarized;
      UMOV_ASSIGN(all, sphere(one, phases, workshop, out));
      const char *const dashes[] = {"solid", "dash", "dot", "dashdot"};
      PlotLine line{
          fmt::format("{}, m = {:g}", name == std::string("paper_au") ? "gold" : "aluminium", m),
          {},
          {},
          name == std::string("paper_au") ? 0u : 1u,
          dashes[within.lines.size() % 4]};
      for (std::size_t i = 0; i < phases.size(); ++i) {
        const auto a = single.at(i, 1).stokes, b = all.at(i, 1).stokes;
        inside.row({name, m, phases[i], 1 - a.i / b.i, b.q / b.i - a.q / a.i});
        line.x.push_back(phases[i]);
        line.y.push_back(100 * (1 - a.i / b.i));
        if (m >= 50 && phases[i] >= 40 && phases[i] <= 140)
          inside_most = std::max(inside_most, 1 - a.i / b.i);
      }
      within.lines.push_back(std::move(line));
    }
  for (const char *object : {"hst", "agena", "box_wing"}) {
    const char *const dashes[] = {"solid", "dash", "dot"};
    PlotLine line{object, {}, {}, among.lines.size(), dashes[among.lines.size()]};
    const auto model = workshop.model(
        workshop.scene(object),
        {.method = LightMethod::Rays, .accuracy = 0.01, .bounces = 5, .max_points = 1u << 16});
    for (const double phase : {40., 80., 120., 150.}) {
      const auto poses = random_poses(61, 24, phase);
      std::vector<double> share, dq, v;
      const StokesTable light = workshop.light(*model, poses, out);
      for (std::size_t k = 0; k < poses.size(); ++k) {
        const auto all = light.at(k, 1).stokes, more = light.indirect[k * light.bands + 1];
        if (!(all.i > 0))
          continue;
        share.push_back(more.i / all.i);
        v.push_back(std::abs(all.v / all.i));
        if (all.i - more.i > 0)
          dq.push_back(std::abs(all.q / all.i - (all.q - more.q) / (all.i - more.i)));
      }
      between.row({object, phase, quantile(share, .5), quantile(share, .9), quantile(dq, .5),
                   quantile(dq, .9), quantile(v, .9)});
      between_most = std::max(between_most, quantile(share, .5));
      dq_most = std::max(dq_most, quantile(dq, .5));
      line.x.push_back(phase);
      line.y.push_back(100 * quantile(share, .5));
    }
    among.lines.push_back(std::move(line));
  }
  out.plots = {within, among};
  out.data = {{"claim_multiple_inside", inside.table()},
              {"claim_multiple_between", between.table()}};
  out.verdict = Verdict::Differs;
  out.summary = fmt::format(
      "inside a smooth-ish surface {:.1f} %; between surfaces {:.0f} % of I in the median",
      100 * inside_most, 100 * between_most);
  out.found = {fmt::format("Within the surface the paper is right for m of 50 and more: at most "
                           "{:.1f} % of I from 40 "
                           "to 140 deg. For rough surfaces (m = 4) it is not.",
                           100 * inside_most),
               fmt::format("Between surfaces it is wrong: light that goes from one part to another "
                           "is up to {:.0f} % of "
                           "I in the median pose of a satellite with parts that see one another, "
                           "changes Q/I by up to "
                           "{:.3f} in the median, and is the only source of circular polarization. "
                           "Full Mueller paths, "
                           "up to five surfaces, 24 poses each; docs/theory/bounces.md has more.",
                           100 * between_most, dq_most)};
  return out;
}

} // namespace umov
