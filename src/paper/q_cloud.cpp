#include "paper/q_cloud.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/core/random.h>

namespace umov {

QCloud q_cloud(const StokesTable &light) {
  QCloud out;
  for (std::size_t i = 0; i < light.is_dark.size(); ++i) {
    const auto b = light.at(i, 0).stokes, g = light.at(i, 1).stokes, r = light.at(i, 2).stokes;
    if (!(b.i > 0 && g.i > 0 && r.i > 0))
      continue;
    out.q.push_back({b.q / b.i, g.q / g.i, r.q / r.i});
    out.intensity.push_back(g.i);
    out.pose.push_back(i);
  }
  return out;
}

QCloud q_cloud(const LightCurve &curve) {
  QCloud out;
  const std::size_t bands = curve.bands.size();
  for (std::size_t i = 0; i < curve.epochs.size(); ++i) {
    QPoint q{};
    for (std::size_t b = 0; b < 3; ++b)
      q[b] = curve.samples[i * bands + b].scattering.q;
    if (!std::isfinite(q[0] + q[1] + q[2]))
      continue;
    out.q.push_back(q);
    out.intensity.push_back(curve.samples[i * bands + 1].intensity);
    out.pose.push_back(i);
  }
  return out;
}

PlotLine space_line(const std::string &name, std::size_t colour, const QCloud &cloud,
                    bool has_markers) {
  PlotLine out{name, {}, {}, colour, "solid"};
  out.has_markers = has_markers;
  for (const QPoint &q : cloud.q) {
    out.x.push_back(q[0]);
    out.y.push_back(q[1]);
    out.z.push_back(q[2]);
  }
  return out;
}

PlotFigure q_space(const std::string &title) {
  PlotFigure out{title, "Q/I blue", "Q/I green", {}};
  out.z_title = "Q/I red";
  return out;
}

PlotLine edge_line(const std::string &name, std::size_t colour, const QCloud &cloud,
                   const PlaneFit &plane) {
  PlotLine out{name, {}, {}, colour, "solid"};
  out.has_markers = true;
  // Along the trace of the blue axis in the plane: most of the spread is blue.
  QPoint along{1, 0, 0};
  double length = 0;
  for (std::size_t k = 0; k < 3; ++k)
    along[k] -= plane.normal[0] * plane.normal[k];
  for (const double a : along)
    length += a * a;
  for (const QPoint &q : cloud.q) {
    double x = 0;
    for (std::size_t k = 0; k < 3; ++k)
      x += along[k] / std::sqrt(length) * q[k];
    out.x.push_back(x);
    out.y.push_back(plane.distance(q));
  }
  return out;
}

std::string normal_text(const PlaneFit &plane) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", plane.normal[0], plane.normal[1], plane.normal[2]);
}

double angle_between_deg(const PlaneFit &a, const PlaneFit &b) {
  double cosine = 0;
  for (std::size_t k = 0; k < 3; ++k)
    cosine += a.normal[k] * b.normal[k];
  return std::acos(std::min(1., std::abs(cosine))) / degree;
}

std::vector<QPoint> random_mixtures(double phase_deg, std::size_t count) {
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  for (const PaperMaterial &one : paper_materials)
    materials.push_back(paper_material(one.name));
  std::vector<QPoint> out;
  std::vector<std::array<FresnelFactors, 3>> factors;
  for (const Material &material : materials) {
    const Surface surface = compiled(material);
    std::array<FresnelFactors, 3> f{};
    for (std::size_t b = 0; b < 3; ++b) {
      f[b] = surface.fresnel(b, std::cos(phase_deg * degree));
      if (material.name == "paper_spectralon") // its light is of the body: as bright as a mirror
        f[b] = {1, 0};
    }
    factors.push_back(f);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto u = uniform4(1, 23, 2 * i), v = uniform4(1, 23, 2 * i + 1);
    const double weights[] = {u[0], u[1], u[2], u[3], v[0], v[1]}; // exponentials: even on simplex
    QPoint q{};
    for (std::size_t b = 0; b < 3; ++b) {
      double s0 = 0, s1 = 0;
      for (std::size_t k = 0; k < factors.size(); ++k) {
        const double w = -std::log(weights[k]);
        s0 += w * factors[k][b].a;
        s1 += w * factors[k][b].b;
      }
      q[b] = s1 / s0;
    }
    out.push_back(q);
  }
  return out;
}

} // namespace umov
