#include <umov/shape/rough_surface.h>

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <umov/core/random.h>

namespace umov {
namespace {

constexpr std::uint32_t stream = 0x726f7567; // "roug"

std::vector<double> noise(std::size_t count, std::uint64_t seed, std::uint32_t octave) {
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; i += 2) { // Box & Muller 1958
    const auto u = uniform4(seed, stream + octave, i);
    const double r = std::sqrt(-2 * std::log(u[0])), phi = 2 * std::numbers::pi * u[1];
    out[i] = r * std::cos(phi);
    if (i + 1 < count)
      out[i + 1] = r * std::sin(phi);
  }
  return out;
}

/// Periodic convolution with a Gaussian along one axis (`stride` 1: x; cells: y).
std::vector<double> smoothed(const std::vector<double> &in, std::size_t cells, double sigma,
                             bool along_y) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(4.5 * sigma));
  std::vector<double> kernel;
  for (std::ptrdiff_t k = -reach; k <= reach; ++k)
    kernel.push_back(std::exp(-0.5 * static_cast<double>(k * k) / (sigma * sigma)));
  std::vector<double> out(in.size());
  const auto n = static_cast<std::ptrdiff_t>(cells);
  for (std::ptrdiff_t y = 0; y < n; ++y)
    for (std::ptrdiff_t x = 0; x < n; ++x) {
      double sum = 0;
      for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
        const std::ptrdiff_t i = ((along_y ? y : x) + k + 64 * n) % n;
        sum += kernel[static_cast<std::size_t>(k + reach)] *
               in[static_cast<std::size_t>(along_y ? i * n + x : y * n + i)];
      }
      out[static_cast<std::size_t>(y * n + x)] = sum;
    }
  return out;
}

double rms(const std::vector<double> &values) {
  double sum = 0;
  for (const double v : values)
    sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Unit-variance field with autocorrelation exp(-r2/l2): noise through a Gaussian of sigma l/2.
std::vector<double> field_of_scale(std::size_t cells, double length, std::uint64_t seed,
                                   std::uint32_t octave) {
  auto out = noise(cells * cells, seed, octave);
  out = smoothed(smoothed(out, cells, length / 2, false), cells, length / 2, true);
  const double scale = 1 / rms(out);
  for (double &v : out)
    v *= scale;
  return out;
}

double rms_slope(const HeightField &f) {
  double sum = 0;
  for (std::size_t y = 0; y < f.cells; ++y)
    for (std::size_t x = 0; x < f.cells; ++x) {
      const double dx = f.at(x + 1, y) - f.at(x, y), dy = f.at(x, y + 1) - f.at(x, y);
      sum += dx * dx + dy * dy;
    }
  return std::sqrt(sum / 2 / static_cast<double>(f.cells * f.cells)) / f.cell_m;
}

} // namespace

Result<HeightField> make_height_field(const RoughSurfaceOptions &o) {
  if (o.cells < 16 || o.cells > 2048)
    return fail(ErrorCode::BadInput, fmt::format("{} cells; 16 to 2048 were expected", o.cells));
  if (!(o.slope >= 0 && o.slope <= 3))
    return fail(ErrorCode::BadInput, fmt::format("slope {:g}; 0 to 3 was expected", o.slope));
  const double longest = static_cast<double>(o.cells) / 8;
  if (!(o.correlation_cells >= 2 && o.correlation_cells <= longest))
    return fail(ErrorCode::BadInput, fmt::format("correlation length {:g} cells; 2 to {:g} was "
                                                 "expected",
                                                 o.correlation_cells, longest));
  if (!(o.hurst >= 0 && o.hurst <= 1) || !(o.cell_m > 0))
    return fail(ErrorCode::BadInput,
                "a Hurst exponent of 0 to 1 and a positive cell were expected");
  HeightField out{o.cells, o.cell_m, std::vector<double>(o.cells * o.cells, 0.0)};
  double length = o.correlation_cells, weight = 1;
  for (std::uint32_t octave = 0; octave == 0 || (o.hurst > 0 && length >= 2); ++octave) {
    const auto part = field_of_scale(o.cells, length, o.seed, octave);
    for (std::size_t i = 0; i < part.size(); ++i)
      out.height_m[i] += weight * part[i];
    length /= 2;
    weight *= std::pow(0.5, o.hurst);
  }
  double mean = 0;
  for (const double h : out.height_m)
    mean += h / static_cast<double>(out.height_m.size());
  const double scale = o.slope / rms_slope(out);
  for (double &h : out.height_m)
    h = (h - mean) * scale;
  return out;
}

Mesh mesh_of(const HeightField &field) {
  Mesh mesh;
  mesh.groups = {"surface"};
  const std::size_t side = field.cells + 1;
  for (std::size_t y = 0; y < side; ++y)
    for (std::size_t x = 0; x < side; ++x)
      mesh.positions.push_back({static_cast<double>(x) * field.cell_m,
                                static_cast<double>(y) * field.cell_m, field.at(x, y)});
  const auto index = [&](std::size_t x, std::size_t y) {
    return static_cast<std::uint32_t>(y * side + x);
  };
  for (std::size_t y = 0; y < field.cells; ++y)
    for (std::size_t x = 0; x < field.cells; ++x) {
      Triangle a, b;
      a.vertex = {index(x, y), index(x + 1, y), index(x + 1, y + 1)};
      b.vertex = {index(x, y), index(x + 1, y + 1), index(x, y + 1)};
      mesh.triangles.push_back(a);
      mesh.triangles.push_back(b);
    }
  return mesh;
}

} // namespace umov
