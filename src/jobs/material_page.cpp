#include <umov/jobs/material_page.h>

#include "jobs/sphere_light.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <umov/io/plot_page.h>
#include <umov/io/scenario.h>
#include <umov/optics/fresnel.h>
#include <umov/scene/pose.h>

namespace umov::jobs {
namespace {

constexpr double rad = pi / 180;

/// One material with its bands.
struct Subject {
  std::string name;
  std::size_t colour = 0;
  std::vector<Band> bands;
  Surface surface;
};

std::vector<double> steps(double from, double to, double step) {
  std::vector<double> out;
  for (double x = from; x <= to + 1e-9; x += step)
    out.push_back(x);
  return out;
}

/// Calls `value(band, x)` over x for every band of every subject.
template <class F>
std::vector<PlotLine> lines_over(const std::vector<Subject> &subjects, const std::vector<double> &x,
                                 F value) {
  std::vector<PlotLine> out;
  for (const Subject &s : subjects)
    for (std::size_t b = 0; b < s.bands.size(); ++b) {
      PlotLine line{
          s.name + " " + s.bands[b].name, x, {}, subjects.size() > 1 ? s.colour : b, plot_dash(b)};
      for (const double at : x)
        line.y.push_back(value(s, b, at));
      out.push_back(std::move(line));
    }
  return out;
}

PlotFigure reflectances(const std::vector<Subject> &subjects) {
  PlotFigure out{"Reflectance of the smooth interface: R_s (upper) and R_p (lower)",
                 "incidence [deg]",
                 "R",
                 {},
                 false};
  for (const double sign : {1.0, -1.0})
    for (PlotLine &line :
         lines_over(subjects, steps(0, 90, 1), [sign](const Subject &s, std::size_t b, double deg) {
           const auto f = s.surface.interface(b).reflection(std::cos(deg * rad));
           return f.a + sign * f.b;
         })) {
      line.name += sign > 0 ? " R_s" : " R_p";
      out.lines.push_back(std::move(line));
    }
  return out;
}

PlotFigure amplitudes(const std::vector<Subject> &subjects) {
  PlotFigure out{"Amplitude |r_s| (upper) and |r_p| (lower)", "incidence [deg]", "|r|", {}, false};
  for (const double sign : {1.0, -1.0})
    for (PlotLine &line :
         lines_over(subjects, steps(0, 90, 1), [sign](const Subject &s, std::size_t b, double deg) {
           const auto f = s.surface.interface(b).reflection(std::cos(deg * rad));
           return std::sqrt(std::max(0.0, f.a + sign * f.b));
         })) {
      line.name += sign > 0 ? " |r_s|" : " |r_p|";
      out.lines.push_back(std::move(line));
    }
  return out;
}

PlotFigure retardances(const std::vector<Subject> &subjects) {
  return {"Phase between r_p and r_s, either way (180 at normal incidence: the field directions)",
          "incidence [deg]", "phase [deg]",
          lines_over(subjects, steps(0, 89.5, 0.5),
                     [](const Subject &s, std::size_t b, double deg) {
                       const auto f = s.surface.interface(b).reflection(std::cos(deg * rad));
                       // 0 and 360 are one phase: a metal's run from 180 down, a film's both ways.
                       return std::abs(std::arg(f.z)) / rad;
                     }),
          false};
}

PlotFigure polarization(const std::vector<Subject> &subjects) {
  return {"Q/I of one reflection (any shape, any roughness)", "phase angle [deg]", "Q/I [%]",
          lines_over(subjects, steps(0, 180, 1),
                     [](const Subject &s, std::size_t b, double deg) {
                       const FresnelFactors f = s.surface.fresnel(b, std::cos(deg * rad));
                       return f.a > 0 ? 100 * f.b / f.a : std::nan("");
                     }),
          false};
}

PlotFigure sphere_polarization(const std::vector<Subject> &subjects, double step_deg) {
  return {"Q/I of a sphere, all its light", "phase angle [deg]", "Q/I [%]",
          lines_over(subjects, steps(0, 180 - step_deg, step_deg),
                     [](const Subject &s, std::size_t b, double deg) {
                       const auto light = sphere_light(s.surface, b, deg * rad);
                       return light && light->i > 0 ? 100 * light->q / light->i : std::nan("");
                     }),
          false};
}

SurfaceDirections in_plane(const Subject &s, double theta_i_deg, double deg) {
  // Positive angles on the mirror side.
  SurfaceDirections at =
      directions_from_angles(theta_i_deg * rad, std::abs(deg) * rad, deg >= 0 ? pi : 0);
  at.disk_rad = s.surface.has_mirror() ? sun_radius_at_1au_rad : 0;
  return at;
}

PlotFigure lobes(const std::vector<Subject> &subjects, double theta_i) {
  return {fmt::format("BRDF in the plane of incidence, source at {:g} deg", theta_i),
          "observer [deg], mirror side positive", "BRDF (m00) [1/sr]",
          lines_over(subjects, steps(-88, 88, 0.5),
                     [theta_i](const Subject &s, std::size_t b, double deg) {
                       const double value = s.surface.brdf(b, in_plane(s, theta_i, deg)).m[0][0];
                       return value > 1e-8 ? value : std::nan("");
                     }),
          true};
}

PlotFigure colour_ratios(const std::vector<Subject> &subjects, double theta_i) {
  PlotFigure out{fmt::format("Colour ratio, first band over last, source at {:g} deg", theta_i),
                 "observer [deg], mirror side positive",
                 "ratio",
                 {},
                 false};
  for (const Subject &s : subjects) {
    PlotLine line{s.name, steps(-80, 80, 1), {}, s.colour, "solid"};
    for (const double deg : line.x) {
      const auto at = in_plane(s, theta_i, deg);
      const double last = s.surface.brdf(s.bands.size() - 1, at).m[0][0];
      const double first = s.surface.brdf(0, at).m[0][0];
      line.y.push_back(last > 1e-12 && first < 20 * last ? first / last : std::nan(""));
    }
    out.lines.push_back(std::move(line));
  }
  return out;
}

PlotFigure indices(const std::vector<Subject> &subjects) {
  PlotFigure out{"Refractive index n (solid) and k (dashed) of the substrate",
                 "wavelength [nm]",
                 "n, k",
                 {},
                 false};
  for (const Subject &s : subjects) {
    const Material &material = s.surface.material();
    const WavelengthRange range = range_of(material.index);
    const double first = std::max(range.first_nm, 300.0), last = std::min(range.last_nm, 1100.0);
    PlotLine n{s.name + " n", {}, {}, s.colour, "solid"},
        k{s.name + " k", {}, {}, s.colour, "dash"};
    for (double nm = first; nm <= last; nm += 5)
      if (const auto eta = index_at(material.index, Wavelength::nm(nm))) {
        n.x.push_back(nm);
        k.x.push_back(nm);
        n.y.push_back(eta->real());
        k.y.push_back(eta->imag());
      }
    out.lines.push_back(std::move(n));
    out.lines.push_back(std::move(k));
  }
  return out;
}

Result<std::vector<Subject>> subjects_of(const MaterialPageRequest &request) {
  std::vector<Subject> out;
  for (const std::string &name : request.names) {
    UMOV_ASSIGN(material, read_material(name));
    std::vector<Band> bands;
    for (const double nm : request.wavelengths_nm)
      bands.push_back({fmt::format("{:g} nm", nm), Wavelength::nm(nm)});
    UMOV_ASSIGN(surface, Surface::compile(material, bands));
    out.push_back({material.name, out.size(), std::move(bands), surface});
  }
  return out;
}

std::vector<PlotFigure> figures_of(const std::vector<Subject> &subjects,
                                   const MaterialPageRequest &request) {
  std::vector<PlotFigure> out{sphere_polarization(subjects, 3)};
  std::vector<Subject> with_interface;
  for (const Subject &s : subjects)
    if (!s.surface.material().measured && !s.surface.interface(0).is_void())
      with_interface.push_back(s);
  if (!with_interface.empty())
    for (PlotFigure &figure : std::vector{polarization(with_interface),
                                          reflectances(with_interface), amplitudes(with_interface),
                                          retardances(with_interface), indices(with_interface)})
      out.push_back(std::move(figure));
  out.push_back(lobes(subjects, request.theta_i_deg));
  if (request.wavelengths_nm.size() > 1)
    out.push_back(colour_ratios(subjects, request.theta_i_deg));
  return out;
}

} // namespace

Result<std::string> material_gallery(const std::vector<double> &wavelengths_nm) {
  std::vector<PlotFigure> figures;
  std::vector<std::string> notes{
      "Each figure: Q/I of a sphere of one material, all its light, with "
      "a point Sun; positive perpendicular to the scattering plane."};
  for (const std::string &name : material_library()) {
    MaterialPageRequest one;
    one.names = {name};
    UMOV_ASSIGN(material, read_material(name));
    one.wavelengths_nm.clear();
    const WavelengthRange range = range_of(material);
    for (const double nm : wavelengths_nm)
      if (nm >= range.first_nm && nm <= range.last_nm)
        one.wavelengths_nm.push_back(nm);
    UMOV_ASSIGN(subjects, subjects_of(one));
    if (one.wavelengths_nm.empty() || subjects.front().surface.is_anisotropic()) {
      notes.push_back(name + ": no one curve (brushed, or its tables end elsewhere).");
      continue;
    }
    figures.push_back(sphere_polarization(subjects, 5));
    figures.back().title = name;
    for (PlotLine &line : figures.back().lines)
      line.name.erase(0, name.size() + 1);
    notes.push_back(name + ": " +
                    (material.description.empty() ? "Table 1 of the paper" : material.description));
  }
  return make_answer_page("All materials", figures, notes);
}

Result<std::string> material_page(const MaterialPageRequest &request) {
  UMOV_ASSIGN(subjects, subjects_of(request));
  std::vector<std::string> notes;
  std::string title;
  for (const Subject &s : subjects) {
    const Material &m = s.surface.material();
    title += (title.empty() ? "" : ", ") + s.name;
    const auto sentence = [](const std::string &text) {
      return text.ends_with('.') ? text : text + ".";
    };
    notes.push_back(fmt::format("{}: {}. {}{}", s.name, describe_polarization(m),
                                sentence(m.description),
                                m.assumed.empty() ? "" : " Assumed: " + sentence(m.assumed)));
  }
  return make_plot_page(title, figures_of(subjects, request), notes);
}

} // namespace umov::jobs
