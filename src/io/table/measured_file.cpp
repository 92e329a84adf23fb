#include <umov/io/measured_file.h>

#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/io/table.h>

namespace umov {
namespace {

std::vector<std::string> mueller_names() {
  std::vector<std::string> out;
  for (int k = 1; k < 16; ++k)
    out.push_back(fmt::format("m{}{}", k / 4, k % 4));
  return out;
}

} // namespace

Result<MeasuredBrdf> read_measured(std::string_view text, const std::string &file, bool accept,
                                   std::vector<std::string> &remarks) {
  const std::vector<std::string> others = mueller_names();
  UMOV_ASSIGN(table,
              read_csv(text, file,
                       {"wavelength_nm", "theta_i_deg", "theta_o_deg", "phi_deg", "m00"}, others));
  std::size_t there = 0;
  for (const std::string &name : others)
    there += table.find(name) != nullptr ? 1u : 0u;
  if (there != 0 && there != others.size()) {
    // A name is missing, or a cell is no number: read as needed, the reader says which, and where.
    std::vector<std::string> all{"wavelength_nm", "theta_i_deg", "theta_o_deg", "phi_deg", "m00"};
    all.insert(all.end(), others.begin(), others.end());
    return tl::unexpected(read_csv(text, file, all).error());
  }
  std::vector<BrdfSample> samples(table.rows());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    BrdfSample &s = samples[i];
    s.wavelength_nm = table.number("wavelength_nm", i);
    s.theta_i_deg = table.number("theta_i_deg", i);
    s.theta_o_deg = table.number("theta_o_deg", i);
    s.phi_deg = table.number("phi_deg", i);
    s.mueller[0] = table.number("m00", i);
    for (std::size_t k = 0; there != 0 && k < others.size(); ++k)
      s.mueller[k + 1] = table.number(others[k], i);
  }
  auto made = MeasuredBrdf::from(std::move(samples), there != 0, accept, remarks);
  if (!made)
    return fail(ErrorCode::BadInput, made.error().message, {file});
  return made;
}

Result<MeasuredBrdf> read_measured_file(const std::filesystem::path &path, bool accept,
                                        std::vector<std::string> &remarks) {
  UMOV_ASSIGN(text, read_file(path));
  return read_measured(text, path.string(), accept, remarks);
}

Result<NormalsTable> read_normals_file(const std::filesystem::path &path) {
  UMOV_ASSIGN(text, read_file(path));
  return read_normals(text, path.string());
}

Result<NormalsTable> read_normals(std::string_view text, const std::string &file) {
  UMOV_ASSIGN(table, read_csv(text, file, {"theta_deg", "density"}));
  NormalsTable out;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    out.angle_deg.push_back(table.number("theta_deg", i));
    out.density.push_back(table.number("density", i));
  }
  return out;
}

} // namespace umov
