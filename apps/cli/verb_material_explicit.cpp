// umov material check --explicit: the statistical model against a ray-traced surface.

#include "tables.h"
#include "verb_material.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/surface/explicit_surface.h>

namespace umov::cli {
namespace {

constexpr Shadowing shadowings[] = {Shadowing::Ashikhmin, Shadowing::Smith,
                                    Shadowing::SmithDirectional, Shadowing::Separable};
constexpr const char *shadowing_names[] = {"ashikhmin", "smith", "smith_dir", "separable"};

struct Mean {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  [[nodiscard]] double value() const { return sum / count; }
  /// Standard error over the realisations; NaN for one.
  [[nodiscard]] double error() const {
    const double variance = (squares / count - value() * value()) / (count - 1);
    return count > 1 ? std::sqrt(std::max(0.0, variance)) : std::nan("");
  }
};

struct Traced {
  Mean once;
  SingleScatter mean;
};

Result<Traced> trace(const ExplicitOptions &o, double theta, const Common &common) {
  Traced out;
  for (int r = 0; r < o.realisations; ++r) {
    UMOV_ASSIGN(field,
                make_height_field({.cells = static_cast<std::size_t>(o.cells),
                                   .slope = o.slope,
                                   .correlation_cells = static_cast<double>(o.correlation_cells),
                                   .hurst = o.hurst,
                                   .seed = o.seed + static_cast<std::uint64_t>(r)}));
    const SingleScatter one =
        trace_height_field(field, theta, o.rays, o.seed + static_cast<std::uint64_t>(r),
                           static_cast<unsigned>(common.threads));
    out.once.add(one.once);
    for (std::size_t k = 0; k < one.flux.size(); ++k)
      out.mean.flux[k] += one.flux[k] / o.realisations;
  }
  return out;
}

} // namespace

std::shared_ptr<ExplicitOptions> add_explicit_options(CLI::App &verb) {
  auto o = std::make_shared<ExplicitOptions>();
  verb.add_flag("--explicit", o->is_wanted,
                "Instead: a ray-traced rough surface (F = 1) against the model of its slopes");
  verb.add_option("--slope", o->slope, "--explicit: rms slope along an axis")
      ->check(CLI::Range(0.01, 2.0))
      ->capture_default_str();
  verb.add_option("--hurst", o->hurst,
                  "--explicit: Hurst exponent of a fractal surface; 0: one scale")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb.add_option("--theta", o->theta_deg, "--explicit: incidences [deg], separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 89.0));
  verb.add_option("--cells", o->cells, "--explicit: cells per side, two triangles each")
      ->check(CLI::Range(64, 2048))
      ->capture_default_str();
  verb.add_option("--realisations", o->realisations, "--explicit: random surfaces")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--rays", o->rays, "--explicit: rays per surface and incidence")
      ->check(CLI::Range(1000, 1'000'000'000))
      ->capture_default_str();
  return o;
}

Result<void> check_explicit(const ExplicitOptions &o, const std::string &output,
                            const Common &common) {
  UMOV_TRY(check_output(output));
  UMOV_ASSIGN(normals,
              make_distribution({"beckmann", {{"alpha", std::sqrt(2.0) * o.slope}}, {}, {}, {}}));
  std::vector<double> explicit_once, error, once[4], distance[4];
  for (const double deg : o.theta_deg) {
    const double theta = deg * pi / 180;
    UMOV_ASSIGN(traced, trace(o, theta, common));
    explicit_once.push_back(traced.once.value());
    error.push_back(traced.once.error());
    for (std::size_t k = 0; k < 4; ++k) {
      const SingleScatter model = model_scatter(*normals, shadowings[k], theta);
      once[k].push_back(model.once);
      double sum = 0;
      for (std::size_t b = 0; b < model.flux.size(); ++b)
        sum += std::abs(model.flux[b] - traced.mean.flux[b]);
      distance[k].push_back(sum / traced.once.value());
    }
  }
  Table table;
  table.add("theta_deg", "deg", "incidence", o.theta_deg);
  table.add("once", "", "explicit: fraction scattered exactly once", std::move(explicit_once));
  table.add("once_err", "", "standard error over the surfaces", std::move(error));
  for (std::size_t k = 0; k < 4; ++k)
    table.add(fmt::format("once_{}", shadowing_names[k]), "", "the model's", std::move(once[k]));
  for (std::size_t k = 0; k < 4; ++k)
    table.add(fmt::format("diff_{}", shadowing_names[k]), "",
              "sum of |model - explicit| over 36 bins of direction over the light scattered once",
              std::move(distance[k]));
  table.note("surface", fmt::format("{} x {} cells, slope {:g}, {} surfaces x {} rays", o.cells,
                                    o.cells, o.slope, o.realisations, o.rays));
  return put_table(output, table, common);
}

} // namespace umov::cli
