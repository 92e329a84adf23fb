#include "console.h"
#include "tables.h"
#include "verbs.h"

#include <cmath>
#include <fmt/format.h>
#include <map>
#include <umov/core/files.h>
#include <umov/io/scenario.h>
#include <umov/io/table.h>
#include <umov/scene/pose.h>
#include <umov/surface/surface.h>

namespace umov::cli {
namespace {

/// Radius of the disk that a mirror shows, as seen from 1 au.
constexpr double solar_radius_rad = sun_radius_at_1au_rad;

struct BrdfOptions {
  std::string material, batch, output;
  double wavelength_nm = 550, theta_i_deg = 0, theta_o_deg = 0, phi_deg = 0, azimuth_deg = 0;
  bool terms = false;
};

struct BrdfRow {
  double wavelength_nm, theta_i_deg, theta_o_deg, phi_deg, azimuth_deg;
};

Result<std::vector<BrdfRow>> rows_of(const BrdfOptions &o) {
  if (o.batch.empty())
    return std::vector<BrdfRow>{
        {o.wavelength_nm, o.theta_i_deg, o.theta_o_deg, o.phi_deg, o.azimuth_deg}};
  UMOV_ASSIGN(text, read_file(o.batch));
  UMOV_ASSIGN(table,
              read_csv(text, o.batch, {"wavelength_nm", "theta_i_deg", "theta_o_deg", "phi_deg"}));
  std::vector<BrdfRow> rows(table.rows());
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = {table.number("wavelength_nm", i), table.number("theta_i_deg", i),
               table.number("theta_o_deg", i), table.number("phi_deg", i), o.azimuth_deg};
  return rows;
}

Result<void> check_angles(const BrdfRow &row, std::size_t index, const BrdfOptions &o) {
  if (row.theta_i_deg >= 0 && row.theta_i_deg <= 90 && row.theta_o_deg >= 0 &&
      row.theta_o_deg <= 90)
    return {};
  return fail(
      o.batch.empty() ? ErrorCode::Usage : ErrorCode::BadInput,
      fmt::format("row {}: theta_i {} deg, theta_o {} deg; angles from the normal between 0 "
                  "and 90 were expected",
                  index + 1, row.theta_i_deg, row.theta_o_deg),
      {o.batch});
}

/// One compiled surface per wavelength of the table.
class Surfaces {
public:
  explicit Surfaces(const Material &material) : material_(material) {}
  Result<Surface> at(double wavelength_nm) {
    if (const auto found = known_.find(wavelength_nm); found != known_.end())
      return found->second;
    const Band band{fmt::format("nm:{}", wavelength_nm), Wavelength::nm(wavelength_nm)};
    UMOV_ASSIGN(surface, Surface::compile(material_, {band}));
    known_.emplace(wavelength_nm, surface);
    return surface;
  }

private:
  Material material_;
  std::map<double, Surface> known_;
};

struct BrdfColumns {
  std::vector<std::vector<double>> in{4}, mueller{16}, terms{4};
};

Result<void> evaluate(const BrdfRow &row, const BrdfOptions &o, Surfaces &surfaces,
                      BrdfColumns &out) {
  UMOV_ASSIGN(surface, surfaces.at(row.wavelength_nm));
  constexpr double rad = pi / 180;
  SurfaceDirections at =
      directions_from_angles(row.theta_i_deg == 90 ? pi / 2 : row.theta_i_deg * rad,
                             row.theta_o_deg == 90 ? pi / 2 : row.theta_o_deg * rad,
                             row.phi_deg * rad, row.azimuth_deg * rad);
  at.disk_rad = surface.has_mirror() ? solar_radius_rad : 0;
  const auto m = surface.brdf(0, at);
  const std::array<double, 4> in{row.wavelength_nm, row.theta_i_deg, row.theta_o_deg, row.phi_deg};
  for (std::size_t c = 0; c < 4; ++c)
    out.in[c].push_back(in[c]);
  for (std::size_t k = 0; k < 16; ++k)
    out.mueller[k].push_back(m.m[k / 4][k % 4]);
  if (o.terms) {
    const auto terms = surface.terms(0, at);
    const std::array<double, 4> parts{terms.specular, terms.body, terms.interreflection,
                                      terms.measured};
    for (std::size_t k = 0; k < parts.size(); ++k)
      out.terms[k].push_back(parts[k]);
  }
  return {};
}

Result<void> run_brdf(const BrdfOptions &o, const Common &common) {
  UMOV_TRY(check_output(o.output));
  UMOV_ASSIGN(material, read_material(o.material));
  UMOV_ASSIGN(rows, rows_of(o));
  Surfaces surfaces(material);
  BrdfColumns columns;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    UMOV_TRY(check_angles(rows[i], i, o));
    UMOV_TRY(evaluate(rows[i], o, surfaces, columns));
  }
  Table table;
  table.add("wavelength_nm", "nm", "wavelength", std::move(columns.in[0]));
  table.add("theta_i_deg", "deg", "source from the normal", std::move(columns.in[1]));
  table.add("theta_o_deg", "deg", "observer from the normal", std::move(columns.in[2]));
  table.add("phi_deg", "deg", "azimuth of the observer minus that of the source",
            std::move(columns.in[3]));
  for (std::size_t k = 0; k < 16; ++k)
    table.add(fmt::format("m{}{}", k / 4, k % 4), "1 / sr", "Mueller BRDF, scattering plane",
              std::move(columns.mueller[k]));
  if (o.terms) {
    table.add("m00_specular", "1 / sr", "part of m00: one reflection by a microfacet",
              std::move(columns.terms[0]));
    table.add("m00_body", "1 / sr", "part of m00: light scattered below the surface",
              std::move(columns.terms[1]));
    table.add("m00_interreflection", "1 / sr", "part of m00: several microfacets",
              std::move(columns.terms[2]));
    table.add("m00_measured", "1 / sr", "part of m00: from a measured table",
              std::move(columns.terms[3]));
  }
  return put_table(o.output, table, common);
}

} // namespace

void add_brdf(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("brdf", "Mueller BRDF [1/sr] of a material");
  auto o = std::make_shared<BrdfOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("material", o->material,
                   "Name of a material, or a TOML file with one [material.NAME] table")
      ->required();
  const std::vector<CLI::Option *> single{
      verb->add_option("--wavelength", o->wavelength_nm, "[nm]")->capture_default_str(),
      verb->add_option("--theta-i", o->theta_i_deg, "Source from the normal [deg]"),
      verb->add_option("--theta-o", o->theta_o_deg, "Observer from the normal [deg]"),
      verb->add_option("--phi", o->phi_deg,
                       "Azimuth of the observer minus that of the source [deg]: 0 = same side")};
  verb->add_option(
      "--azimuth", o->azimuth_deg,
      "Azimuth of the source from the direction field of an anisotropic surface [deg]");
  auto *batch = verb->add_option(
      "--batch", o->batch, "CSV with columns wavelength_nm, theta_i_deg, theta_o_deg, phi_deg");
  for (CLI::Option *option : single)
    batch->excludes(option);
  verb->add_flag("--terms", o->terms, "Add the parts of m00");
  add_table_output(*verb, o->output);
  add_common(*verb, *common, true);
  verb->callback([o, common, exit_with] {
    const auto done = run_brdf(*o, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
