// The statistical model of a rough surface against the surface itself.

#include <umov/jobs/material_check.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/constants.h>
#include <umov/surface/explicit_surface.h>

namespace umov::jobs {
namespace {

struct NamedMasking {
  Shadowing shadowing;
  const char *name;
};
constexpr std::array<NamedMasking, 4> maskings{{{Shadowing::Ashikhmin, "ashikhmin"},
                                                {Shadowing::Smith, "smith"},
                                                {Shadowing::SmithDirectional, "smith_dir"},
                                                {Shadowing::Separable, "separable"}}};

struct SurfaceMean {
  double sum = 0, squares = 0;
  std::size_t count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  [[nodiscard]] double value() const { return sum / static_cast<double>(count); }
  /// Standard error over the realisations; NaN for one.
  [[nodiscard]] double error() const {
    const double n = static_cast<double>(count);
    const double variance = (squares / n - value() * value()) / (n - 1);
    return count > 1 ? std::sqrt(std::max(0.0, variance)) : std::nan("");
  }
};

struct TracedSurfaces {
  SurfaceMean once;
  SingleScatter mean;
};

/// How many of the surfaces are traced.
struct SurfaceProgress {
  const Monitor &monitor;
  std::size_t done = 0, total = 0;
};

Result<TracedSurfaces> trace_surfaces(const RoughSurfaceRequest &request, double theta_rad,
                                      unsigned threads, SurfaceProgress &progress) {
  TracedSurfaces out;
  for (std::size_t r = 0; r < request.realisations; ++r) {
    if (progress.monitor.is_cancelled())
      return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
    UMOV_ASSIGN(field, make_height_field({.cells = request.cells,
                                          .slope = request.slope,
                                          .correlation_cells = request.correlation_cells,
                                          .hurst = request.hurst,
                                          .seed = request.seed + r}));
    const SingleScatter one =
        trace_height_field(field, theta_rad, request.rays, request.seed + r, threads);
    out.once.add(one.once);
    for (std::size_t k = 0; k < one.flux.size(); ++k)
      out.mean.flux[k] += one.flux[k] / static_cast<double>(request.realisations);
    progress.monitor.advance("surfaces", ++progress.done, progress.total);
  }
  return out;
}

/// What the model with one joint masking says, beside what was traced.
struct ModelColumns {
  std::vector<double> once, distance;
  void add(const SingleScatter &model, const TracedSurfaces &traced) {
    once.push_back(model.once);
    double sum = 0;
    for (std::size_t b = 0; b < model.flux.size(); ++b)
      sum += std::abs(model.flux[b] - traced.mean.flux[b]);
    distance.push_back(sum / traced.once.value());
  }
};

Result<void> check_surfaces(const RoughSurfaceRequest &request) {
  if (request.realisations < 1 || request.rays < 1)
    return fail(ErrorCode::BadInput,
                fmt::format("{} realisations with {} rays; at least one of each was expected",
                            request.realisations, request.rays));
  for (const double deg : request.theta_deg)
    if (!(deg >= 0 && deg <= 89))
      return fail(ErrorCode::BadInput,
                  fmt::format("incidence {} deg; 0 to 89 deg was expected", deg));
  return {};
}

} // namespace

Result<Table> rough_surface_table(const RoughSurfaceRequest &request, unsigned threads,
                                  const Monitor &monitor) {
  UMOV_TRY(check_surfaces(request));
  // The slopes along an axis are Gaussian, so that the normals are Beckmann's.
  UMOV_ASSIGN(normals, make_distribution(
                           {"beckmann", {{"alpha", std::sqrt(2.0) * request.slope}}, {}, {}, {}}));
  SurfaceProgress progress{monitor, 0, request.theta_deg.size() * request.realisations};
  std::vector<double> once, error;
  std::array<ModelColumns, maskings.size()> models;
  for (const double deg : request.theta_deg) {
    const double theta = deg * pi / 180;
    UMOV_ASSIGN(traced, trace_surfaces(request, theta, threads, progress));
    once.push_back(traced.once.value());
    error.push_back(traced.once.error());
    for (std::size_t k = 0; k < maskings.size(); ++k)
      models[k].add(model_scatter(*normals, maskings[k].shadowing, theta), traced);
  }
  Table table;
  table.add("theta_deg", "deg", "incidence", request.theta_deg);
  table.add("once", "", "explicit: fraction scattered exactly once", std::move(once));
  table.add("once_err", "", "standard error over the surfaces", std::move(error));
  for (std::size_t k = 0; k < maskings.size(); ++k)
    table.add(fmt::format("once_{}", maskings[k].name), "", "the model's",
              std::move(models[k].once));
  for (std::size_t k = 0; k < maskings.size(); ++k)
    table.add(fmt::format("diff_{}", maskings[k].name), "",
              "sum of |model - explicit| over 36 bins of direction over the light scattered once",
              std::move(models[k].distance));
  table.note("surface",
             fmt::format("{} x {} cells, slope {:g}, {} surfaces x {} rays", request.cells,
                         request.cells, request.slope, request.realisations, request.rays));
  return table;
}

} // namespace umov::jobs
