// Figures 1 and 12: smooth interfaces.

#include "paper/figures/figures.h"
#include "paper/row_table.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/core/golden_section.h>
#include <umov/io/index_file.h>
#include <umov/optics/fresnel.h>

namespace umov {
namespace {

struct SmoothSurface {
  std::string name;
  std::complex<double> eta;
};

double phase_deg(std::complex<double> r) {
  if (std::abs(r.imag()) < 1e-12 * std::abs(r)) // real: the sign of a zero means nothing
    return r.real() < 0 ? 180 : 0;
  const double value = std::arg(r) / degree;
  return value < 0 ? value + 360 : value;
}

/// Incidence of least R_p, which has one minimum.
double incidence_of_least_p(std::complex<double> eta) {
  const auto r_p = [&](double deg) {
    return std::norm(fresnel_amplitudes(std::cos(deg * degree), eta).p);
  };
  return golden_minimum(r_p, 0, 90, 1e-5);
}

void add_surface(const SmoothSurface &surface, std::size_t colour, PaperFigure &figure,
                 RowTable &rows) {
  PlotFigure amplitude{surface.name + ": amplitudes at 500 nm", "incidence [deg]", "|r|", {}},
      reflectance{surface.name + ": reflectances at 500 nm", "incidence [deg]", "R", {}},
      phase{surface.name + ": phases at 500 nm", "incidence [deg]", "phase [deg]", {}};
  PlotLine rs{"|r_s|", {}, {}, colour, "solid"}, rp{"|r_p|", {}, {}, colour + 1, "dash"};
  PlotLine big_s{"R_s", {}, {}, colour, "solid"}, big_p{"R_p", {}, {}, colour + 1, "dash"};
  PlotLine phase_s{"s", {}, {}, colour, "solid"}, phase_p{"p", {}, {}, colour + 1, "dash"},
      relative{"p against s", {}, {}, 6, "dot"};
  for (int i = 0; i < 180; ++i) {
    const double at = 0.5 * i;
    const FresnelAmplitudes r = fresnel_amplitudes(std::cos(at * degree), surface.eta);
    for (PlotLine *line : {&rs, &rp, &big_s, &big_p, &phase_s, &phase_p, &relative})
      line->x.push_back(at);
    rs.y.push_back(std::abs(r.s));
    rp.y.push_back(std::abs(r.p));
    big_s.y.push_back(std::norm(r.s));
    big_p.y.push_back(std::norm(r.p));
    phase_s.y.push_back(phase_deg(r.s));
    phase_p.y.push_back(phase_deg(r.p));
    relative.y.push_back(phase_deg(std::conj(r.s) * r.p));
    rows.row({surface.name, at, r.s.real(), r.s.imag(), r.p.real(), r.p.imag(), std::norm(r.s),
              std::norm(r.p), relative.y.back()});
  }
  amplitude.lines = {rs, rp};
  reflectance.lines = {big_s, big_p};
  phase.lines = {phase_s, phase_p, relative};
  figure.plots.insert(figure.plots.end(), {amplitude, reflectance, phase});
}

/// First incidence at which R_s - R_p reaches a tenth.
double incidence_of_difference(std::complex<double> eta) {
  for (double at = 0; at < 90; at += 0.01) {
    const FresnelAmplitudes r = fresnel_amplitudes(std::cos(at * degree), eta);
    if (std::norm(r.s) - std::norm(r.p) >= 0.02)
      return at;
  }
  return 90;
}

} // namespace

Result<PaperFigure> make_fig1(PaperWorkshop &) {
  UMOV_ASSIGN(gold_table, find_index("Au_Johnson"));
  UMOV_ASSIGN(gold, index_at(gold_table, Wavelength::nm(500)));
  UMOV_ASSIGN(glass_table, find_index("NBK7_Schott"));
  UMOV_ASSIGN(glass, index_at(glass_table, Wavelength::nm(500)));
  PaperFigure out;
  out.id = "fig1";
  out.title = "Figure 1: Fresnel reflection of gold and BK7";
  out.claim = "Field coefficients, reflectances and phases at 0.5 um; the s polarization vanishes "
              "near 57 deg on BK7, and above 25 deg s and p differ much on both.";
  RowTable rows({{"material", "", "substrate"},
                 {"theta_i", "deg", "angle of incidence"},
                 {"r_s_re", "", "amplitude of s, real part; axes (s, p, k) right-handed"},
                 {"r_s_im", "", "imaginary part"},
                 {"r_p_re", "", "amplitude of p, real part"},
                 {"r_p_im", "", "imaginary part"},
                 {"reflectance_s", "", "R_s"},
                 {"reflectance_p", "", "R_p"},
                 {"retardance", "deg", "phase of r_p against r_s"}});
  add_surface({"gold", gold}, 0, out, rows);
  add_surface({"BK7", glass}, 0, out, rows);
  out.data = {{"fig1", rows.table()}};
  const double brewster = incidence_of_least_p(glass);
  out.verdict = Verdict::Partly;
  out.summary =
      fmt::format("curves as in the paper; at {:.2f} deg on BK7 it is p that vanishes", brewster);
  out.found = {
      fmt::format(
          "R_p of BK7 vanishes at {:.3f} deg, Brewster's atan n; the paper's sentence names "
          "the s polarization, its curves do not.",
          brewster),
      fmt::format("R_s - R_p reaches .02 at {:.1f} deg on BK7 and {:.1f} deg on gold: \"above 25 "
                  "deg\" holds for glass and is generous for a metal.",
                  incidence_of_difference(glass), incidence_of_difference(gold)),
      "Phases follow fields that are right-handed with the beam before and after reflection: r_p "
      "and r_s then differ by 180 deg at normal incidence. The paper's r_s has the other sign, "
      "which leaves I and Q as they are and turns the retardance by 180 deg."};
  const double n = glass.real();
  out.checks = {{"incidence of R_p = 0, BK7 [deg]", brewster, std::atan(n) / degree, 2e-4,
                 "Brewster: atan n"},
                {"R at normal incidence, gold", std::norm(fresnel_amplitudes(1, gold).s),
                 std::norm((gold - 1.) / (gold + 1.)), 1e-12, "|(n-1)/(n+1)|^2"},
                {"R at normal incidence, BK7", std::norm(fresnel_amplitudes(1, glass).p),
                 (n - 1) * (n - 1) / ((n + 1) * (n + 1)), 1e-12, "((n-1)/(n+1))^2"}};
  return out;
}

Result<PaperFigure> make_fig12(PaperWorkshop &) {
  UMOV_ASSIGN(table, find_index("Au_Johnson"));
  UMOV_ASSIGN(table1, builtin_index("paper_au"));
  PaperFigure out;
  out.id = "fig12";
  out.title = "Figure 12: dispersion of gold";
  out.claim = "n and k of gold against wavelength.";
  RowTable rows({{"wavelength", "nm", "in vacuum"}, {"n", "", "index"}, {"k", "", "absorption"}});
  PlotLine n{"n, Johnson & Christy 1972", {}, {}, 0, "solid"},
      k{"k, Johnson & Christy 1972", {}, {}, 1, "dash"};
  for (double nm = 300; nm <= 900; nm += 5) {
    UMOV_ASSIGN(eta, index_at(table, Wavelength::nm(nm)));
    rows.row({nm, eta.real(), eta.imag()});
    n.x.push_back(nm);
    n.y.push_back(eta.real());
    k.x.push_back(nm);
    k.y.push_back(eta.imag());
  }
  PlotLine n1{"n, paper's Table 1", {}, {}, 4, "solid"},
      k1{"k, paper's Table 1", {}, {}, 5, "solid"};
  n1.has_markers = k1.has_markers = true;
  double largest = 0;
  for (const Band &band : paper_bands()) {
    UMOV_ASSIGN(eta, index_at(table1, band.wavelength));
    UMOV_ASSIGN(measured, index_at(table, band.wavelength));
    largest = std::max(largest, std::abs(eta - measured));
    n1.x.push_back(band.wavelength.nm());
    n1.y.push_back(eta.real());
    k1.x.push_back(band.wavelength.nm());
    k1.y.push_back(eta.imag());
  }
  out.plots = {{"Refractive index of gold", "wavelength [nm]", "n, k", {n, k, n1, k1}}};
  out.data = {{"fig12", rows.table()}};
  out.verdict = Verdict::Agrees;
  out.summary = fmt::format("Table 1's gold is Johnson & Christy's within {:.2f}", largest);
  out.found = {fmt::format("Measured values (Johnson & Christy 1972, refractiveindex.info) and the "
                           "three of the paper's Table 1 differ by at most {:.2f} in n + ik.",
                           largest)};
  return out;
}

} // namespace umov
