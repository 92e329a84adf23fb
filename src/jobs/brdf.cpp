#include <umov/jobs/brdf.h>

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/scene/pose.h>
#include <umov/surface/surface.h>

namespace umov::jobs {
namespace {

Result<void> check_angles(const BrdfGeometry &row, const std::string &which, const Where &where) {
  if (row.theta_i_deg >= 0 && row.theta_i_deg <= 90 && row.theta_o_deg >= 0 &&
      row.theta_o_deg <= 90)
    return {};
  return fail(where.file.empty() ? ErrorCode::Usage : ErrorCode::BadInput,
              fmt::format("{}theta_i {} deg, theta_o {} deg; angles from the normal between 0 "
                          "and 90 were expected",
                          which, row.theta_i_deg, row.theta_o_deg),
              where);
}

/// One compiled surface per wavelength of the table.
class Surfaces {
public:
  explicit Surfaces(const Material &material) : material_(material) {}
  Result<const Surface *> at(double wavelength_nm) {
    auto found = known_.find(wavelength_nm);
    if (found == known_.end()) {
      const Band band{fmt::format("nm:{}", wavelength_nm), Wavelength::nm(wavelength_nm)};
      UMOV_ASSIGN(surface, Surface::compile(material_, {band}));
      found = known_.emplace(wavelength_nm, std::move(surface)).first;
    }
    return &found->second;
  }

private:
  Material material_;
  std::map<double, Surface> known_;
};

struct BrdfColumns {
  std::vector<std::vector<double>> in{4}, mueller{16}, terms{5};
  void reserve(std::size_t rows) {
    for (auto *columns : {&in, &mueller})
      for (std::vector<double> &column : *columns)
        column.reserve(rows);
  }
};

Result<void> evaluate(const BrdfGeometry &row, bool with_terms, Surfaces &surfaces,
                      BrdfColumns &out) {
  UMOV_ASSIGN(found, surfaces.at(row.wavelength_nm));
  const Surface &surface = *found;
  constexpr double rad = pi / 180;
  SurfaceDirections at =
      directions_from_angles(row.theta_i_deg == 90 ? pi / 2 : row.theta_i_deg * rad,
                             row.theta_o_deg == 90 ? pi / 2 : row.theta_o_deg * rad,
                             row.phi_deg * rad, row.azimuth_deg * rad);
  at.disk_rad = surface.has_mirror() ? sun_radius_at_1au_rad : 0;
  const auto m = surface.brdf(0, at);
  const std::array<double, 4> in{row.wavelength_nm, row.theta_i_deg, row.theta_o_deg, row.phi_deg};
  for (std::size_t c = 0; c < 4; ++c)
    out.in[c].push_back(in[c]);
  for (std::size_t k = 0; k < 16; ++k)
    out.mueller[k].push_back(m.m[k / 4][k % 4]);
  if (with_terms) {
    const auto terms = surface.terms(0, at);
    const std::array<double, 5> parts{terms.specular, terms.body, terms.interreflection,
                                      terms.measured, terms.haze};
    for (std::size_t k = 0; k < parts.size(); ++k)
      out.terms[k].push_back(parts[k]);
  }
  return {};
}

} // namespace

Result<std::vector<BrdfGeometry>> read_brdf_geometries(const std::string &path,
                                                       double azimuth_deg) {
  UMOV_ASSIGN(text, read_file(path));
  UMOV_ASSIGN(table,
              read_csv(text, path, {"wavelength_nm", "theta_i_deg", "theta_o_deg", "phi_deg"}));
  std::vector<BrdfGeometry> rows(table.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i] = {table.number("wavelength_nm", i), table.number("theta_i_deg", i),
               table.number("theta_o_deg", i), table.number("phi_deg", i), azimuth_deg};
    UMOV_TRY(check_angles(rows[i], "", {path, static_cast<std::size_t>(table.number("line", i))}));
  }
  return rows;
}

Result<Table> brdf_table(const BrdfRequest &request, const Monitor &monitor) {
  Surfaces surfaces(request.material);
  BrdfColumns columns;
  columns.reserve(request.rows.size());
  for (std::size_t i = 0; i < request.rows.size(); ++i) {
    if (monitor.is_cancelled())
      return fail(ErrorCode::Interrupted,
                  fmt::format("stopped by the user after {} of {}", i,
                              counted(request.rows.size(), "geometry", "geometries")));
    UMOV_TRY(check_angles(request.rows[i],
                          request.rows.size() > 1 ? fmt::format("row {}: ", i + 1) : "",
                          {request.file}));
    UMOV_TRY(evaluate(request.rows[i], request.with_terms, surfaces, columns));
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
  if (request.with_terms) {
    table.add("m00_specular", "1 / sr", "part of m00: one reflection by a microfacet",
              std::move(columns.terms[0]));
    table.add("m00_body", "1 / sr", "part of m00: light scattered below the surface",
              std::move(columns.terms[1]));
    table.add("m00_interreflection", "1 / sr", "part of m00: several microfacets",
              std::move(columns.terms[2]));
    table.add("m00_measured", "1 / sr", "part of m00: from a measured table",
              std::move(columns.terms[3]));
    table.add("m00_haze", "1 / sr", "part of m00: scratches, dust and edges",
              std::move(columns.terms[4]));
  }
  return table;
}

} // namespace umov::jobs
